# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

from setuptools import find_packages, setup

PACKAGE = "acts_skins"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(exclude=["test"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    python_requires=">=3.10",
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    zip_safe=False,
    description="Driver and reconstruction of a skin in one process, and several skins of a robot.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            f"{name} = acts_skins.programs:{name}" for name in ("skin_contacts", "skin_overview", "skins", "tactile")
        ]
    },
)
