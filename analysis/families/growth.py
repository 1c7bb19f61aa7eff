# How time grows with size: exponents by implementation and family; and what each order of elimination leaves to do.
import pandas

from analysis.core.statistics import power_law_exponent, power_law_interval

LEAST = 3  # sizes


def growth(scenes, mechanisms):
    """A row for each family, form and implementation with at least LEAST sizes: t ~ n^a, t ~ flops^b."""
    if "n" not in mechanisms:
        return pandas.DataFrame()
    known = mechanisms.set_index("scene")
    timed = scenes[scenes.status.isin(["ok", "slower"]) & scenes.step_us.notna() & ~scenes.family.str.contains("filled")]
    rows = []
    for (family, scheme, name), group in timed.groupby(["family", "scheme", "implementation"], sort=False):
        group = group[group.scene.isin(known.index)]
        sizes = known.loc[group.scene, ["n", "flops"]].astype(float)
        if sizes.n.nunique() < LEAST:
            continue
        exponent, low, high = power_law_interval(sizes.n.to_numpy(), group.step_us.to_numpy())
        rows.append({"family": family, "scheme": scheme, "implementation": name, "sizes": len(group),
                     "least": sizes.n.min(), "most": sizes.n.max(), "exponent": exponent, "low": low, "high": high,
                     "per_flop": power_law_exponent(sizes.flops.to_numpy(), group.step_us.to_numpy()),
                     "record": " ".join(dict.fromkeys(group.record))})
    return pandas.DataFrame(rows)


def orderings(about):
    """A row for each scene and order of elimination, as `mbs describe` computes them."""
    return pandas.DataFrame([
        {"scene": scene, "n": record.output.get("variables"), "ordering": name, "factor": one["factor_nonzeros"],
         "per_column": one["factor_nonzeros"] / record.output["variables"], "flops": one["flops"], "height": one["height"],
         "record": record.name}
        for scene, record in about.items()
        for name, one in (record.output.get("elimination") or {}).get("orderings", {}).items() if one])
