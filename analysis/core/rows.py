# Tables as pages show them: rows are dictionaries.


def rows_of(table):
    """[row], None where there is nothing."""
    return table.astype(object).where(table.notna(), None).to_dict("records")


def grouped(table, key):
    """[(key, rows)], in the table's order; what is empty stays NaN."""
    return [(name, group.to_dict("records")) for name, group in table.groupby(key, sort=False)]
