# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Refuses to be imported in another interpreter than the main one, since the extension module has one state a process.

From Python 3.12 on the import of the extension module refuses that itself.
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
