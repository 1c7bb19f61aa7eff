# What reuse of factors saves: tangents.csv from work.csv.
import pandas

from analysis.accuracy.front import finished

REUSE = {"every-step": "default", "kept": "default", "kept tight": "default",
         "saddle every-step": "saddle", "saddle kept": "saddle"}
STEP = 1.25e-3


def tangents(work):
    """DataFrame: each setting that reuses factors beside the one that does not, at the step nearest STEP."""
    done, found = finished(work), []
    for (subject, implementation), mine in done.groupby(["subject", "implementation"], sort=False):
        near = mine[(mine.step / STEP - 1).abs() < 1e-6]
        for row in near[near.setting.isin(REUSE)].to_dict("records"):
            usual = near[near.setting == REUSE[row["setting"]]]
            if usual.empty:
                continue
            usual = usual.iloc[0]
            found.append({
                "subject": subject, "implementation": implementation, "setting": row["setting"],
                "beside": usual.setting, "step": row["step"],
                "factorizations_per_step": row["factorizations_per_step"],
                "saved": 1 - row["factorizations_per_step"] / usual.factorizations_per_step,
                "passes_per_step": row["passes_per_step"], "usual_passes": usual.passes_per_step,
                "time_ratio": row["time"] / usual.time, "error": row["error"],
                "usual_error": usual.error, "status": row["status"], "raw_file": row["raw_file"],
                "usual_raw_file": usual.raw_file})
    return pandas.DataFrame(found)
