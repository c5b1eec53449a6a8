"""driftlab: the stochastic errors of inertial sensors, from Python.

    from driftlab import Client, local
    local.characterise("my_gyro.csv", rate_hz=100)                     # in a process of its own, no server
    client = Client("http://127.0.0.1:8477")                           # or through a daemon
    recording = client.upload("my_gyro.csv", device="phone-07", rate_hz=100)
    client.characterise(recording["id"])
"""
from __future__ import annotations

from . import local
from .client import Client
from .problems import ClientProblem, Conflict, Forbidden, InvalidInput, JobCancelled, NotFound, Problem, ServerProblem, Unavailable
from .results import Calibration, Channel, Characterisation, Curve, Investigation, OutageEvaluation, arrays
from .tables import ParameterTable, Trends
from .transport import Retry

__version__ = "0.1.0"
__all__ = [
    "Calibration", "Channel", "Characterisation", "Client", "ClientProblem", "Conflict", "Curve", "Forbidden", "InvalidInput",
    "Investigation", "JobCancelled", "NotFound", "OutageEvaluation", "ParameterTable", "Problem", "Retry", "ServerProblem", "Trends",
    "Unavailable", "arrays", "local"]
