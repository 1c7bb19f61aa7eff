# The answer to "What do a library's settings gain or cost?", from the table.
from analysis.core.text import number


def answers(tables, view):
    rows = tables["alternatives"]
    rows = rows[rows.status == "ok"]
    if rows.empty:
        return [{"text": "Not measured: nothing that was tried was timed.", "anchor": ""}]
    found = []
    for base, group in rows.groupby("base", sort=False):
        slower, faster = group[group.low > 1], group[group.high < 1]
        text = (f"{base}: of {len(group)} times with other settings ({group.alternative.nunique()} on {group.scene.nunique()} scenes) {len(slower)} "
                f"are shown to be longer, {len(faster)} shorter")
        most = group.loc[group.ratio.idxmax()]
        text += f"; the longest is {most.alternative} on {most.scene}, {number(most.ratio)} times the time"
        if len(faster):
            least = faster.loc[faster.ratio.idxmin()]
            text += f"; the shortest is {least.alternative} on {least.scene}, {number(least.ratio)} times"
        found.append({"anchor": base.replace("/", "-"), "text": text + "."})
    return found
