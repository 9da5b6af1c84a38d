#!/usr/bin/env python3
"""Writes the sky of scenes/hidden-sun.pbrt: dim, bluer and darker toward the zenith, with a tiny sun of one pixel.

    scripts/make_hidden_sun_sky.py scenes/textures/hidden-sun.hdr

A latitude-longitude map of 256 x 128 pixels in Radiance's RGBE format, z up: row 0 is the zenith. All of a row but the
sun is one colour, so that run lengths make the file small.
"""
import math
import sys

WIDTH, HEIGHT = 256, 128
SUN_X, SUN_Y = 148, 38  # 54 degrees from the zenith
# The sun brings a horizontal plane 3.7 times as much light as the sky (luminance).
SUN = (24000.0, 21000.0, 17000.0)


def sky(y):
    elevation = math.cos(math.pi * (y + 0.5) / HEIGHT)
    if elevation < 0:
        return (0.10, 0.09, 0.08)
    return tuple(low + (high - low) * math.sqrt(elevation) for low, high in zip((0.9, 0.9, 0.9), (0.25, 0.45, 0.9)))


def rgbe(color):
    mantissa, exponent = math.frexp(max(color))
    scale = mantissa * 256 / max(color)
    return bytes(int(c * scale) for c in color) + bytes([exponent + 128])


def run_lengths(values):
    out = bytearray()
    start = 0
    while start < len(values):
        end = start
        while end < len(values) and end - start < 127 and values[end] == values[start]:
            end += 1
        out += bytes([128 + end - start, values[start]])
        start = end
    return out


def main(path):
    with open(path, "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
        for y in range(HEIGHT):
            row = [rgbe(SUN if (x, y) == (SUN_X, SUN_Y) else sky(y)) for x in range(WIDTH)]
            file.write(bytes([2, 2, WIDTH >> 8, WIDTH & 255]))
            for channel in range(4):
                file.write(run_lengths([pixel[channel] for pixel in row]))


main(sys.argv[1])
