#!/usr/bin/env python3
"""Plots a run: forces at the rail seats and their spectrum, the wheel's contact force, the sensing stones.

usage: cases/plot_run.py DIR [PICTURE]        (Debian: python3-h5py, python3-matplotlib; default DIR/run.png)

An example of reading results back: every dataset has its unit in the attribute "units", rows beyond "n_committed" are
not whole.
"""
import os
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def rows(file, name):
    """The committed rows of a dataset."""
    return file[name][: file.attrs["n_committed"]]


def seat_forces(folder):
    """Seats by name: end of each window [s], mean force on the sleeper in it [N], up is positive."""
    with h5py.File(folder + "/coupling.h5") as file:
        time, window = rows(file, "time"), file.attrs["window_s"]
        impulses = {seat: rows(file, f"seats/{seat}/impulse") for seat in file["seats"]}
    # [window, cell, axis], axis 2 is normal; row 0 holds the initial values
    return {seat: (time[1:], impulse[1:, :, 2].sum(axis=1) / window) for seat, impulse in impulses.items()}


def contact_force(folder):
    """Time [s] and force [N] between wheel and rail."""
    with h5py.File(folder + "/fem.h5") as file:
        return file["TimeSeries/time"][:], file["TimeSeries/wheel/contact_force"][:]


def stones(folder):
    """Sensing stones by name: time [s], displacement [m] along x, y, z."""
    path = folder + "/sensors.h5"
    if not os.path.exists(path):
        return {}
    with h5py.File(path) as file:
        time = rows(file, "time")
        return {name: (time, rows(file, name + "/displacement")) for name in file
                if isinstance(file[name], h5py.Group) and "rotation" in file[name]}


def amplitude(time, value):
    """One-sided amplitude spectrum with a Hann window: frequency [Hz], amplitude in the unit of `value`."""
    window = np.hanning(len(value))
    spectrum = np.fft.rfft((value - value.mean()) * window) * 2 / window.sum()
    return np.fft.rfftfreq(len(value), time[1] - time[0]), np.abs(spectrum)


def plot(folder, picture):
    figure, axes = plt.subplots(2, 2, figsize=(11, 7), constrained_layout=True)
    for name, (time, force) in seat_forces(folder).items():
        axes[0, 0].plot(1e3 * time, 1e-3 * force, label=name)
        axes[1, 0].loglog(*amplitude(time, force), label=name)
    axes[0, 0].set(xlabel="time [ms]", ylabel="seat force [kN]")
    axes[1, 0].set(xlabel="frequency [Hz]", ylabel="amplitude [N]", xlim=(10, 3000))
    if os.path.exists(folder + "/fem.h5"):
        time, force = contact_force(folder)
        axes[0, 1].plot(1e3 * time, 1e-3 * force)
    axes[0, 1].set(xlabel="time [ms]", ylabel="wheel on rail [kN]")
    for name, (time, displacement) in stones(folder).items():
        axes[1, 1].plot(1e3 * time, 1e6 * (displacement[:, 2] - displacement[0, 2]), label=name)
    axes[1, 1].set(xlabel="time [ms]", ylabel="stone, vertical [um]")
    for panel in axes.flat:
        panel.grid(alpha=0.3)
        if panel.get_legend_handles_labels()[0]:
            panel.legend()
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    run = sys.argv[1]
    target = sys.argv[2] if len(sys.argv) == 3 else run + "/run.png"
    plot(run, target)
    print("picture in", target)
