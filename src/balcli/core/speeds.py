"""Speeds of rotation."""

from __future__ import annotations

import math

RPM = math.pi / 30  # rad/s
