from .running import results, run
from .tasks import Processes, Task, fingerprint

__all__ = [
    "Processes",
    "Task",
    "fingerprint",
    "results",
    "run",
]
