# The rows of the page.


def context(tables, view):
    return {"rows": tables["setups"].to_dict("records")}
