# What belongs together.
def gather(pairs):
    """{key: its values} of (key, value) pairs, in their order."""
    found = {}
    for key, value in pairs:
        found.setdefault(key, []).append(value)
    return found
