#!/usr/bin/python3
"""Writes welch.txt beside this file: a record and its spectra by scipy.signal (Debian: python3-scipy).

Not run by the tests. Line by line: a name, the number of values, the values.
"""
import os

import numpy
import scipy
import scipy.signal

interval = 2.5e-4
time = interval * numpy.arange(1000)
# Two tones, one between the lines, a decay, a drift, and a fixed sequence of noise.
noise = numpy.random.RandomState(7)
x = 3.0 + 1.5 * numpy.sin(2 * numpy.pi * 120 * time) + 40 * time + noise.standard_normal(time.size)
y = 0.7 * numpy.sin(2 * numpy.pi * 333.3 * time + 0.4) * numpy.exp(-8 * time) + 0.3 * numpy.roll(x, 3) + noise.standard_normal(time.size)

vectors = {"x": x, "y": y}
for name, window, length, overlap in [("hann_256_128", "hann", 256, 128), ("boxcar_250_0", "boxcar", 250, 0),
                                      ("hann_255_100", "hann", 255, 100)]:
    options = dict(fs=1 / interval, window=window, nperseg=length, noverlap=overlap, detrend="constant")
    frequency, density = scipy.signal.welch(x, **options)
    cross = scipy.signal.csd(x, y, **options)[1]
    vectors[name + "_frequency"] = frequency
    vectors[name + "_density"] = density
    vectors[name + "_cross_real"] = cross.real
    vectors[name + "_cross_imaginary"] = cross.imag

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "welch.txt"), "w") as out:
    out.write("# scipy %s, numpy %s\n" % (scipy.__version__, numpy.__version__))
    for name, values in vectors.items():
        out.write("%s %d\n%s\n" % (name, len(values), " ".join("%.17g" % v for v in values)))
