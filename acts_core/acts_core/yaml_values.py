# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""A loader of YAML that refuses values which Python cannot hold or show with a ValueError."""

from __future__ import annotations

import reprlib
from typing import Any

import yaml


class YamlLoader(yaml.SafeLoader):
    """Raises ValueError for a whole number of thousands of digits, and for what is not as its tag says: ``!!bool x``.

    Python refuses to read such a number in decimal, and to write one at all; in hexadecimal it reads one. Of a wrong
    tag yaml raises whatever comes of it.
    """

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        """See the class."""
        try:
            return super().construct_object(node, deep)
        except (LookupError, AttributeError) as error:
            kind, line = node.tag.rpartition(":")[2], node.start_mark.line + 1
            raise ValueError(f"{reprlib.repr(node.value)} cannot be read as {kind}, in line {line}") from error


def _whole_number(loader: YamlLoader, node: yaml.ScalarNode) -> int:
    value: int = loader.construct_yaml_int(node)
    str(value)
    return value


YamlLoader.add_constructor("tag:yaml.org,2002:int", _whole_number)
