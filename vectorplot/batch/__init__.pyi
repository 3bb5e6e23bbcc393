from .running import Tally, frame_tasks, results, run
from .tasks import Processes, Task, cluster, fingerprint

__all__ = [
    "Processes",
    "Tally",
    "Task",
    "cluster",
    "fingerprint",
    "frame_tasks",
    "results",
    "run",
]
