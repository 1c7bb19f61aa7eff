# What every job of the workflow starts with: the study it belongs to, and how it reports errors.
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

from study.pipeline import profile as profiles
from study.pipeline.contenders import Contender, from_json, own
from study.pipeline.errors import StudyError
from study.pipeline.layout import Layout, read_json, read_run


@dataclass(frozen=True)
class Study:
    """One results directory: its profile and who takes part, with their builds."""
    layout: Layout
    profile: profiles.Profile
    contenders: dict   # name -> Contender
    control: Contender
    contexts: dict     # environment -> context of its raw files
    own: set           # names of those that stand on no library

    def context(self, contender):
        return self.contexts[contender.environment]

    def contender(self, name):
        return self.control if name == self.control.name else self.contenders[name]

    def at(self, scene):
        """Those who take part in a scene."""
        return [contender for contender in self.contenders.values() if contender.at(scene)]


def open_study(results):
    layout = Layout(Path(results).resolve())
    run = read_run(layout)
    profile = profiles.read(layout.results / "profile.yaml", run["profile"])
    [control] = from_json([run["control"]]).values()
    return Study(layout, profile, from_json(run["contenders"]), control, run["contexts"],
                 own(read_json(layout.registry)))


def study_job(function):
    """Runs `function(study)` for the command line RESULTS."""
    return job(lambda: function(open_study(sys.argv[1])))


def column_job(function):
    """Runs `function(study, variables)` for the command line RESULTS VARIABLES."""
    return job(lambda: function(open_study(sys.argv[1]), int(sys.argv[2])))


def job(function):
    """Exit status of a job; a StudyError becomes one line "error: ..." that the front shows."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        function()
        return 0
    except StudyError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
