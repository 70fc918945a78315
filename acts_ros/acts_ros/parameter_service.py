# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The services of a node's parameters; whatever a request contains, it gets an answer and the node goes on."""

from __future__ import annotations

import weakref

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

_LONGEST_NAME = 64
_TYPES = {kind.value for kind in Parameter.Type}
_NAMES = {
    Parameter.Type.NOT_SET.value: "no value",
    Parameter.Type.BOOL.value: "true or false",
    Parameter.Type.INTEGER.value: "a whole number",
    Parameter.Type.DOUBLE.value: "a number with a decimal point, such as 1.0",
    Parameter.Type.STRING.value: "text",
    Parameter.Type.BYTE_ARRAY.value: "an array of bytes",
    Parameter.Type.BOOL_ARRAY.value: "an array of true and false",
    Parameter.Type.INTEGER_ARRAY.value: "an array of whole numbers",
    Parameter.Type.DOUBLE_ARRAY.value: "an array of numbers with a decimal point, such as [1.0, 2.0]",
    Parameter.Type.STRING_ARRAY.value: "an array of texts",
}


# What `ros2 param set` takes words such as on and 5 for.
_LIKE_TEXT = {Parameter.Type.BOOL.value, Parameter.Type.INTEGER.value, Parameter.Type.DOUBLE.value}
_QUOTED = "; for `ros2 param set`, put on, off, yes, no, true, false and numbers in quotes twice: \"'on'\""


class CheckedParameterService(ParameterService):
    """Those of rclpy, which raise out of the executor, and so end the process, on a value of no known type.

    A value of the wrong type is refused in words; rclpy gives the numbers of the types. So is a parameter that the node
    does not have, or that cannot be changed.
    """

    def __init__(self, node: Node) -> None:
        super().__init__(node)
        self._checked_node = weakref.ref(node)

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        results: list[SetParametersResult] = []
        for parameter in request.parameters:
            reason = self._malformed(parameter)
            if reason:
                results.append(SetParametersResult(successful=False, reason=reason))
            else:
                one = SetParameters.Request(parameters=[parameter])
                results += super()._set_parameters_callback(one, SetParameters.Response()).results
        response.results = results
        return response

    def _set_parameters_atomically_callback(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        reason = next(filter(None, map(self._malformed, request.parameters)), "")
        if not reason:
            return super()._set_parameters_atomically_callback(request, response)
        response.result = SetParametersResult(successful=False, reason=reason)
        return response

    def _malformed(self, parameter: ParameterMessage) -> str:
        """What is wrong with a name or the type of a value, or an empty string."""
        given, node = parameter.value.type, self._checked_node()
        if given not in _TYPES:
            return f"{parameter.name}: type = {given}: allowed is {min(_TYPES)} to {max(_TYPES)}"
        if node is None:
            return ""
        if not node.has_parameter(parameter.name):
            # rclpy takes one whose name is empty, and keeps whatever it is given; of others it leaves out the name.
            return f"{parameter.name[:_LONGEST_NAME]!r} is no parameter of {node.get_fully_qualified_name()}"
        descriptor = node.describe_parameter(parameter.name)
        if descriptor.read_only:
            name = node.get_fully_qualified_name()
            return f"{parameter.name} is read when {name} starts, and cannot be changed later: start it anew with this"
        if descriptor.dynamic_typing or given == descriptor.type:
            return ""
        hint = _QUOTED if descriptor.type == Parameter.Type.STRING.value and given in _LIKE_TEXT else ""
        return f"{parameter.name}: given was {_NAMES[given]}; allowed is {_NAMES[descriptor.type]}{hint}"
