#!/usr/bin/env python3
"""A speed bump for car.cpp: heights under the four wheels, one row a step of 1.25 ms: ./road.py > road.csv"""
import math
import sys

STEP, SPEED, BASE = 1.25e-3, 10.0, 2.6  # s, m/s, m
HEIGHT, LENGTH, AT = 0.05, 1.0, 2.0  # m; where it begins, before the front wheels at the start


def height(x):
    """Of the road at x, m: half a wave of a cosine up and down, smooth at both ends."""
    along = (x - AT) / LENGTH
    return HEIGHT / 2 * (1 - math.cos(2 * math.pi * along)) if 0 < along < 1 else 0.0


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 2.0
    print("road FL,road FR,road RL,road RR")
    for k in range(round(seconds / STEP) + 2):
        x = SPEED * STEP * k
        print(f"{height(x):.12g},{height(x):.12g},{height(x - BASE):.12g},{height(x - BASE):.12g}")


main()
