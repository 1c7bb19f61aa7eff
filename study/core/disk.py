# Whether there is room to write.
import shutil
import tempfile

from analysis.core.errors import StudyError


def writable(folder):
    """Makes a folder; StudyError unless it can be written to and has room."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError as error:
        raise StudyError(f"cannot write to {folder}: {error.strerror}") from error
    if shutil.disk_usage(folder).free < 100 * 2**20:
        raise StudyError(f"less than 100 MB free for {folder}")
