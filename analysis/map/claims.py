# The claims ledger: each claim of the paper with our figure, its interval and a computed verdict.
from analysis.map.claims_libraries import compilers, dense_pairs, tuned_blas
from analysis.map.claims_maps import over_fill, regions
from analysis.map.claims_solvers import pivoting, solvers, sparse_against_dense
from analysis.map.claims_starting import starting_sparse, table1, table2_claims

LEDGER = (table1, table2_claims, dense_pairs, solvers, pivoting, starting_sparse, tuned_blas, sparse_against_dense,
          over_fill, regions, compilers)  # in the order of the rows


def claims(results):
    """All rows of the ledger; every claim has at least one."""
    return [row for claim in LEDGER for row in claim(results)]
