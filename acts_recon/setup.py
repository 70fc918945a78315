# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_recon"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed", "sparse/dictionaries/*.npz"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    python_requires=">=3.10",
    install_requires=["acts_core", "numpy", "scipy"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="Tactile images from few samples, and contacts, slip, impacts, outlines, spectra, gait and objects.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [f"{name} = acts_recon.programs:{name}" for name in ("gait", "reconstruction")],
    },
)
