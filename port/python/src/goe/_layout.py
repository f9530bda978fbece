"""The C structs as numpy types, laid out as the compiler did."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._goe import ffi

PRIMITIVES = {
    "float": np.float32, "double": np.float64, "_Bool": np.bool_, "int": np.int32, "unsigned int": np.uint32,
    "int8_t": np.int8, "uint8_t": np.uint8, "int16_t": np.int16, "uint16_t": np.uint16,
    "int32_t": np.int32, "uint32_t": np.uint32, "int64_t": np.int64,
}  # fmt: skip


def dtype_of(type_or_name: Any) -> np.dtype[Any]:
    """The numpy type of a C type. Enumerations are int32."""
    c_type = ffi.typeof(type_or_name) if isinstance(type_or_name, str) else type_or_name
    if c_type.kind == "struct":
        names, fields = zip(*c_type.fields)
        return np.dtype(
            {
                "names": list(names),
                "formats": [dtype_of(field.type) for field in fields],
                "offsets": [field.offset for field in fields],
                "itemsize": ffi.sizeof(c_type),
            }
        )
    if c_type.kind == "array":
        return np.dtype((dtype_of(c_type.item), (c_type.length,)))
    if c_type.kind == "enum":
        return np.dtype(np.int32)
    return np.dtype(PRIMITIVES[c_type.cname])


IMAGE = dtype_of("goe_image_t")
ESTIMATE = dtype_of("goe_estimate_t")
HAZARD = dtype_of("goe_hazard_t")
RULE = dtype_of("goe_python_rule_t")
