"""`python -m ecsim` is the command `ecsim`."""

import sys

from .cli import main

sys.exit(main())
