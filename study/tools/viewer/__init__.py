# The viewer behind study/view: a motion becomes an HTML page and a PNG contact sheet.
