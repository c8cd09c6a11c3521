"""`python -m naod`."""

import sys

from naod.cli.main import main

sys.exit(main())
