def claims(results):
    return []
