# The one schema of all tables: analysis/PART/schema.yaml says of every table its columns, each [type, unit, meaning].
# Tables are written and read through it, and the pages print it.
import math
from functools import cache
from pathlib import Path

from analysis.core.files import ROOT, StudyError, digest, from_yaml, read_object, write, write_json
from analysis.core.records import archive_of, need_same_origin, read_part

TYPES = ("text", "number", "flag")
DIGESTS = "tables.json"  # of a part: those of its records and tables


@cache
def of_part(part):
    return read(ROOT / "analysis" / part / "schema.yaml")


def read(path):
    """{table: {column: (type, unit, meaning)}}; every table has a `record`, the name of one that its row comes from."""
    found = from_yaml(path.read_text(encoding="utf-8"))
    for table, columns in found.items():
        wrong = [name for name, one in columns.items() if len(one) != 3 or one[0] not in TYPES or not all(isinstance(word, str) for word in one)]
        if wrong or "record" not in columns:
            raise StudyError(f"{path}: {table}: {', '.join(wrong) or 'record'}: needs [type, unit, meaning], types are {', '.join(TYPES)}")
    return found


def conform(rows, columns, what):
    """Rows, or a table of them, as a table with exactly these columns, in this order and of these types; what they lack is empty."""
    import pandas  # who only looks whether tables were changed waits for no half a second
    frame = pandas.DataFrame(rows)
    if unknown := [name for name in frame.columns if name not in columns]:
        raise StudyError(f"{what}: columns that its schema does not know: {', '.join(unknown)}")
    frame = frame.reindex(columns=list(columns))
    for name, (kind, _, _) in columns.items():
        if kind == "number":
            values = frame[name].astype(object)
            try:  # as Python reads it: pandas.to_numeric is off by an ulp for a third of all texts
                frame[name] = values.mask(values.isna() | (values == ""), math.nan).astype(float)
            except ValueError as error:
                raise StudyError(f"{what}: {name}: {error}") from error
        elif kind == "flag":
            frame[name] = frame[name].map({True: True, False: False, "True": True, "False": False}).astype("boolean")
        else:
            frame[name] = frame[name].fillna("").astype(str)
    return frame.reset_index(drop=True)


def write_tables(folder, part, tables, records):
    """Writes the tables of a part into folder/PART and the digests of these and of the records; returns them as the schema has them."""
    schema = of_part(part)
    if set(tables) != set(schema):
        raise StudyError(f"analysis/{part}/tables.py makes {sorted(tables)}, its schema has {sorted(schema)}")
    found, base = {}, Path(folder) / part
    (base / DIGESTS).unlink(missing_ok=True)  # so that whoever is interrupted here is not told of changed tables
    for name, columns in schema.items():
        found[name] = conform(tables[name], columns, f"{part}/{name}.csv")
        write(base / f"{name}.csv", lambda partial, table=found[name]: table.to_csv(partial, index=False))
    write_json(base / DIGESTS, {"records": digest_of(records), "tables": {name: digest(base / f"{name}.csv") for name in found}})
    return found


def digest_of(records):
    return digest("\n".join(f"{one.name} {one.digest}" for one in records))


def records_of(folder, part, context, drawn=False):
    """All records of a part, by name; StudyError naming a table that was changed, a record that was or that is of another machine or
    commit than the set's `context`, or if they are not those that its tables were made of: in a stored set, or one that must be `drawn`."""
    need_unchanged(folder, part)
    found, archive, kept = read_part(folder, part), archive_of(folder, part), Path(folder) / part / DIGESTS
    known = read_object(kept, records=str)["records"] if kept.exists() else ""
    if known != digest_of(found) and (drawn or known and archive.exists()):
        mend = f"{archive} holds other records than {kept} says: restore both" if archive.exists() else f"run study/figures {folder}"
        raise StudyError(f"{Path(folder) / part}: its tables are not those of its records: {mend}")
    for record in found:
        need_same_origin(record, context, f"{folder}/raw/{part}")
    return found


def read_table(folder, part, name):
    """A table of a set; StudyError if it is not as it was written. A set of an older schema may have columns that are gone."""
    path, kept = Path(folder) / part / f"{name}.csv", Path(folder) / part / DIGESTS
    if not kept.exists():
        raise StudyError(f"{kept} is missing: study/figures makes the tables again from the records")
    need_unchanged(folder, part)
    columns = of_part(part)[name]
    import pandas
    try:
        frame = pandas.read_csv(path, dtype=str, keep_default_na=False, usecols=columns.__contains__)
    except (OSError, ValueError) as error:
        raise StudyError(f"{path}: cannot be read: {error}") from error
    return conform(frame, columns, str(path))


def need_unchanged(folder, part):
    """StudyError naming the first table of a part that is not what was written there."""
    kept = Path(folder) / part / DIGESTS
    for name, known in (read_object(kept, tables=dict)["tables"] if kept.exists() else {}).items():
        path = kept.with_name(f"{name}.csv")
        if not path.exists() or digest(path) != known:
            raise StudyError(f"{path} is {'not as it was written' if path.exists() else 'missing'}: restore it, or "
                             f"remove {kept} to have the tables made again from the records")
