# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Refuses an import in an interpreter other than the main one, as the extension module has one state for each process.

From Python 3.12 on, the extension module itself refuses such an import.
"""

import sys

if sys.version_info < (3, 12):
    try:
        import _xxsubinterpreters as _interpreters  # type: ignore[import-not-found,unused-ignore]
    except ImportError:  # other implementations of Python have no such module
        pass
    else:
        if _interpreters.get_current() != _interpreters.get_main():
            raise ImportError("meshorder works in the main interpreter of a process only, not in a subinterpreter")
