from os import PathLike
from typing import Any, Callable, Dict, List, Optional, Sequence, Tuple, Union

import numpy

__version__: str
KINDS: Tuple[str, ...]
SHAPES: Tuple[str, ...]

class Error(ValueError):
    file: Optional[str]
    line: Optional[int]
    key: Optional[str]
    value: Optional[str]
    limit: Optional[str]

class Cancelled(RuntimeError): ...

class Job:
    def __init__(self, file: Union[str, PathLike[str]]) -> None: ...
    @classmethod
    def of_text(cls, toml: str, name: str = ..., folder: Union[str, PathLike[str]] = ...) -> Job: ...

class Program:
    setup: str
    gcode: str
    statistics: Dict[str, Any]
    warnings: List[str]
    moves: numpy.ndarray

class Verification:
    broken: List[str]
    figures: Dict[str, Any]
    left: numpy.ndarray
    gouge: numpy.ndarray
    part: numpy.ndarray
    grid: Tuple[float, float, float]

class Run:
    good: bool
    errors: List[str]
    statistics: Dict[str, Any]
    samples: numpy.ndarray

def plan(
    job: Union[Job, str, PathLike[str]],
    blend: float = ...,
    progress: Optional[Callable[[str, float], None]] = ...,
) -> List[Program]: ...
def verify(
    job: Union[Job, str, PathLike[str]],
    gcode: str,
    after: Sequence[str] = ...,
    pitch: Optional[float] = ...,
    engagement: bool = ...,
) -> Verification: ...
def simulate(
    gcode: str, settings: str = ..., samples: bool = ..., dialect: str = ..., name: str = ...
) -> Run: ...
def set_threads(threads: int) -> None: ...
