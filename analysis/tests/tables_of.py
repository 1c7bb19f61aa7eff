# Tables of a part from synthetic records.
from analysis.core.schema import conform, of_part


def tables_of(part, build, view, *records):
    """As the schema has them. `records`: records and lists of them."""
    found, schema = build([one for group in records for one in (group if isinstance(group, list) else [group])], view), of_part(part)
    assert set(found) == set(schema)
    return {name: conform(rows, schema[name], name) for name, rows in found.items()}
