# How jobs tell the front what they do: lines of JSON in one file of the set.
import json
import threading


class Progress:
    """Appends events of one column."""

    def __init__(self, studyset, part, column):
        self.path, self.part, self.column, self.lock = studyset.progress, part, column, threading.Lock()

    def expect(self, cells):
        """So many more cells are known of."""
        self._event(expected=cells)

    def done(self):
        self._event(expected=0, done=1)

    def tell(self, text):
        self._event(text=text)

    def _event(self, **what):
        line = json.dumps({"part": self.part, "column": self.column} | what) + "\n"
        with self.lock, open(self.path, "a", encoding="utf-8") as file:
            file.write(line)


class Reader:
    """Follows the events that Progress appends."""

    def __init__(self, path):
        path.write_text("")
        self.file, self.rest = open(path, encoding="utf-8"), ""

    def events(self):
        self.rest += self.file.read()
        *lines, self.rest = self.rest.split("\n")
        return [json.loads(line) for line in lines if line]


def duration(seconds):
    """The text "1 min 20 s"."""
    seconds = max(0, round(seconds))
    if seconds < 60:
        return f"{seconds} s"
    if seconds < 3600:
        return f"{seconds // 60} min {seconds % 60} s"
    return f"{seconds // 3600} h {seconds % 3600 // 60} min"
