# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Refuses other interpreters than the main one, before the extension module is loaded: it has one state in a process.

From Python 3.12 on the import itself does.
"""

import sys

if sys.version_info < (3, 12):
    try:
        import _xxsubinterpreters as _interpreters  # type: ignore[import-not-found,unused-ignore]
    except ImportError:  # of other implementations of Python
        pass
    else:
        if _interpreters.get_current() != _interpreters.get_main():
            raise ImportError("meshorder works in the main interpreter only, not in another one of its process")
