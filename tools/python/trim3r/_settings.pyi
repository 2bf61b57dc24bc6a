# SPDX-License-Identifier: Apache-2.0
# Made by declare.py when the package is built.
from typing import Dict, Tuple

SETTINGS: Dict[str, Tuple[str, str, int, int]]
