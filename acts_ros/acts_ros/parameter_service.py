# Copyright 2026 ACTS contributors
# SPDX-License-Identifier: Apache-2.0

"""The services of a node's parameters; whatever a request contains, it gets an answer and the node goes on."""

from __future__ import annotations

from collections.abc import Sequence

from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.parameter_service import ParameterService

_TYPES = {kind.value for kind in Parameter.Type}


class CheckedParameterService(ParameterService):
    """Those of rclpy, which raise out of the executor, and so end the process, on a value of no known type."""

    def _set_parameters_callback(
        self, request: SetParameters.Request, response: SetParameters.Response
    ) -> SetParameters.Response:
        reason = _malformed(request.parameters)
        if not reason:
            return super()._set_parameters_callback(request, response)
        response.results = [SetParametersResult(successful=False, reason=reason) for _ in request.parameters]
        return response

    def _set_parameters_atomically_callback(
        self, request: SetParametersAtomically.Request, response: SetParametersAtomically.Response
    ) -> SetParametersAtomically.Response:
        reason = _malformed(request.parameters)
        if not reason:
            return super()._set_parameters_atomically_callback(request, response)
        response.result = SetParametersResult(successful=False, reason=reason)
        return response


def _malformed(parameters: Sequence[ParameterMessage]) -> str:
    """What is wrong with a request, or an empty string."""
    for parameter in parameters:
        if parameter.value.type not in _TYPES:
            return f"{parameter.name}: type = {parameter.value.type}: allowed is {min(_TYPES)} to {max(_TYPES)}"
    return ""
