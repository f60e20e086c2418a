"""Picks the build of the extension module for this processor.

A wheel may hold builds for newer x86-64 processors beside the plain one: `_native_v3.abi3.so` for
x86-64-v3 (AVX2) and `_native_v4.abi3.so` for x86-64-v4 (AVX-512). They draw the same bytes; newer
ones are faster. The environment variable BASRELIEF_SIMD (v2, v3 or v4) asks for one of them.
"""

import importlib
import importlib.machinery
import importlib.util
import os
import platform
import sys
from pathlib import Path

# What Linux calls the features that a level asks for over the one before.
_FEATURES = {
    "v2": {"cx16", "lahf_lm", "popcnt", "sse4_1", "sse4_2", "ssse3"},
    "v3": {"abm", "avx", "avx2", "bmi1", "bmi2", "f16c", "fma", "movbe", "xsave"},
    "v4": {"avx512bw", "avx512cd", "avx512dq", "avx512f", "avx512vl"},
}


def _levels():
    """The levels that this processor has, the least first; None where that is not known."""
    if sys.platform != "linux" or platform.machine() != "x86_64":
        return None
    try:
        with open("/proc/cpuinfo") as lines:
            flags = next(line for line in lines if line.startswith("flags"))
    except (OSError, StopIteration):
        return None
    present = set(flags.split())
    levels = []
    for level, features in _FEATURES.items():
        if not features <= present:
            break
        levels.append(level)
    return levels


def load():
    """The module `basrelief._native`."""
    builds = {"v2": None}
    for path in Path(__file__).parent.glob("_native_v*.abi3.so"):
        builds[path.name[len("_native_") : -len(".abi3.so")]] = path
    if len(builds) == 1:
        # Built from source, for the machine that it is on.
        return importlib.import_module("basrelief._native")
    levels = _levels()
    asked = os.environ.get("BASRELIEF_SIMD")
    if asked is not None and (asked not in builds or asked not in (levels or ["v2"])):
        raise ImportError(f"BASRELIEF_SIMD={asked}: this package or this processor has no {asked}")
    if levels == []:
        raise ImportError(
            "this wheel is for x86-64-v2 (SSE 4.2) and later processors;"
            " install from source: pip install --no-binary basrelief basrelief"
        )
    level = asked or max((level for level in levels or ["v2"] if level in builds), default="v2")
    path = builds[level]
    if path is None:
        return importlib.import_module("basrelief._native")
    name = "basrelief._native"
    loader = importlib.machinery.ExtensionFileLoader(name, str(path))
    spec = importlib.util.spec_from_file_location(name, str(path), loader=loader)
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    sys.modules[name] = module
    return module
