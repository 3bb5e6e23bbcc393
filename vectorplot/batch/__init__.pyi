from .answers import Submits
from .executors import Here, Processes, cluster
from .run import Outcome, Tally, results, run
from .tasks import Task, fingerprint

__all__ = ["Here", "Outcome", "Processes", "Submits", "Tally", "Task", "cluster", "fingerprint", "results", "run"]
