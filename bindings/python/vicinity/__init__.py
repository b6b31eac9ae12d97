# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The package that Python imports: all of it is the compiled module's."""

import sys as _sys

from ._vicinity import *
from ._vicinity import __doc__, __version__, primitive

_sys.modules[__name__ + ".primitive"] = primitive
