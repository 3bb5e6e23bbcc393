from .running import Outcome, Tally, frame_tasks, results, run
from .tasks import Here, Processes, Submits, Task, cluster, fingerprint

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
