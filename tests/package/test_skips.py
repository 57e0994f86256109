# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""In CI a test that is skipped without an expected reason fails."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
TESTS = {
    "expected": "import pytest\n@pytest.mark.skipif(True, reason='needs OpenFOAM')\ndef test(): pass\n",
    "unexpected": "import pytest\ndef test(): pytest.skip('no such mesh')\n",
    "decorated": "import pytest\n@pytest.mark.skipif(True, reason='there is no tool')\ndef test(): pass\n",
    "module": "import pytest\npytest.importorskip('no_such_module')\ndef test(): pass\n",
    "wrong": "import pytest\n@pytest.mark.xfail(strict=True)\ndef test(): assert False\n",
}


@pytest.mark.package
def test_unexpected_skips_fail_in_ci(tmp_path):
    shutil.copy(ROOT / "tests" / "conftest.py", tmp_path)
    for name, text in TESTS.items():
        (tmp_path / f"test_{name}.py").write_text(text)

    def failed(**environment):
        environment = {name: value for name, value in os.environ.items() if name != "CI"} | environment
        done = subprocess.run([sys.executable, "-m", "pytest", "-q", "-rfE", "--continue-on-collection-errors", tmp_path],
                              env=environment, capture_output=True, text=True, check=False)
        return {name for name in TESTS if re.search(f"^(FAILED|ERROR) .*test_{name}.py", done.stdout, re.MULTILINE)}, done.stdout

    assert failed()[0] == set()
    names, output = failed(CI="true")
    assert names == {"unexpected", "decorated", "module"}, output
    assert "no such mesh" in output and "tests/conftest.py lists" in output
