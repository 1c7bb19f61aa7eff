# The tables of the map from its records.
import pandas

from analysis.core import schema
from analysis.core.controls import controls
from analysis.map import carry, tidy
from analysis.map.cells import table as cells
from analysis.map.claims_libraries import compilers, dense_pairs, tuned_blas
from analysis.map.claims_maps import over_fill, regions
from analysis.map.claims_solvers import pivoting, solvers, sparse_against_dense
from analysis.map.claims_starting import starting_sparse, table1, table2_claims
from analysis.map.results import Results, with_samples
from analysis.map.timed import AFTER

# The claims ledger: each claim of the paper with our figure, its interval and a computed verdict; in the order of the rows.
LEDGER = (table1, table2_claims, dense_pairs, solvers, pivoting, starting_sparse, tuned_blas, sparse_against_dense,
          over_fill, regions, compilers)


def claims(results):
    """All rows of the ledger; every claim has at least one."""
    return [row for claim in LEDGER for row in claim(results)]


def build(records, view):
    found = {"tidy": tidy.tidy(records), "scenes": tidy.scenes(records), "verification": tidy.verification(records)}
    known = schema.of_part("map")
    found = {name: schema.conform(frame, known[name], f"map/{name}.csv") for name, frame in found.items()}
    results = Results(found, view)
    seeds = results.tidy[results.tidy.kind == "seeds"]
    return found | {"cells": cells(results), "claims": pandas.DataFrame(claims(results)), "spread": carry.components(results.timing, with_samples(seeds)),
                    "controls": controls(results.timing[results.timing.process > AFTER])}
