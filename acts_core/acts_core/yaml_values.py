# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A loader of YAML that refuses whole numbers too long to be shown in a message."""

from __future__ import annotations

import yaml


class YamlLoader(yaml.SafeLoader):
    """Raises ValueError for a whole number of thousands of digits, however it is written.

    Python refuses to read one in decimal, and to write one at all; in hexadecimal it reads one.
    """


def _whole_number(loader: YamlLoader, node: yaml.ScalarNode) -> int:
    value: int = loader.construct_yaml_int(node)
    str(value)
    return value


YamlLoader.add_constructor("tag:yaml.org,2002:int", _whole_number)
