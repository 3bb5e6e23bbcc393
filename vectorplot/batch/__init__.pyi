from .calls import Submits
from .executors import Here, Processes, cluster
from .film_frames import frame_tasks
from .running import Outcome, Tally, results, run
from .tasks import Task, fingerprint

__all__ = [
    "Here",
    "Outcome",
    "Processes",
    "Submits",
    "Tally",
    "Task",
    "cluster",
    "fingerprint",
    "frame_tasks",
    "results",
    "run",
]
