# The answer to "What do a library's settings gain or cost?", from the table.
from analysis.core.text import number


def answers(tables, view):
    rows = tables["alternatives"].loc[lambda rows: rows.status == "ok"]
    if rows.empty:
        return [{"text": "Not measured: nothing that was tried was timed.", "anchor": ""}]
    slower, faster = rows[rows.low > 1], rows[rows.high < 1]
    most = rows.loc[rows.ratio.idxmax()]
    text = (f"{rows.alternative.nunique()} other settings of {rows.base.nunique()} variants were timed on {rows.scene.nunique()} scenes. Of {len(rows)} times "
            f"{len(slower)} are shown to be longer than with the variant's own, {len(faster)} shorter; the longest is {most.alternative} on {most.scene}, "
            f"{number(most.ratio)} times the time")
    if len(faster):
        least = faster.loc[faster.ratio.idxmin()]
        text += f"; the shortest is {least.alternative} on {least.scene}, {number(least.ratio)} times"
    return [{"anchor": "", "text": text + "."}]
