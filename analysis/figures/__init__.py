# One script a figure: `python3 -m analysis.figures.NAME RESULTS_DIR OUTPUT...`.
