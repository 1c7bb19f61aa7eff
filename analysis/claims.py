# The claims ledger: each claim of the paper with our figure, its interval and a computed verdict.
import csv
import sys

from analysis.claims_libraries import compilers, dense_pairs, tuned_blas
from analysis.claims_maps import over_fill, regions
from analysis.claims_solvers import pivoting, solvers, sparse_against_dense
from analysis.claims_starting import starting_sparse, table1, table2_claims
from analysis.ledger import COLUMNS
from analysis.loader import TableError, load

LEDGER = (table1, table2_claims, dense_pairs, solvers, pivoting, starting_sparse, tuned_blas,
          sparse_against_dense, over_fill, regions, compilers)  # in the order of the rows


def claims(results):
    """All rows of the ledger, each a dict with COLUMNS; every claim has at least one row."""
    machine = f"{results.context.get('cpu_model', 'unknown')} " \
              f"({results.context.get('machine', 'unknown')})"
    return [row | {"machine": machine} for claim in LEDGER for row in claim(results)]


def write(rows, path):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(f"usage: {sys.argv[0]} RESULTS_DIR OUTPUT.csv")
    try:
        write(claims(load(sys.argv[1])), sys.argv[2])
    except (TableError, OSError) as error:
        sys.exit(f"error: {error}")
