# The one kind of error that a user can mend: a single clear line, exit status 2.
class StudyError(Exception):
    """What is wrong, where, and what to do about it, in one line."""
