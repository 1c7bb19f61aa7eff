# The tables of the map from its records.
import pandas

from analysis.core import schema
from analysis.map import carry, tidy
from analysis.map.cells import table as cells
from analysis.map.claims import claims
from analysis.map.results import Results, with_samples


def build(records, view):
    found = {"tidy": tidy.tidy(records), "scenes": tidy.scenes(records), "verification": tidy.verification(records)}
    known = schema.of_part("map")
    found = {name: schema.conform(frame, known[name], f"map/{name}.csv") for name, frame in found.items()}
    results = Results(found, view)
    seeds = results.tidy[results.tidy.kind == "seeds"]
    return found | {"cells": cells(results), "claims": pandas.DataFrame(claims(results)), "controls": carry.controls(results.timing),
                    "spread": carry.components(results.timing, with_samples(seeds)),
                    "disturbance": carry.disturbance(records)}
