#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draws the table of quickstart: one point for each phase of each instance.

Usage: plot.py TABLE PICTURE
"""

import sys

import matplotlib

matplotlib.use("Agg")  # no display needed
import matplotlib.pyplot as plt
import numpy

if len(sys.argv) != 3:
    sys.exit(__doc__.strip())
k, x = numpy.loadtxt(sys.argv[1], delimiter=",", skiprows=1, unpack=True)
plt.figure(figsize=(8, 5))
plt.plot(k, x, ",", color="black", alpha=0.5)
plt.xlabel("damping k")
plt.ylabel("x at the end of each period")
plt.savefig(sys.argv[2], dpi=150)
