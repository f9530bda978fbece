"""Licenses of the installed packages, as their owners state them, by SPDX names; others are unknown."""

from __future__ import annotations

LLVM = "Apache-2.0 WITH LLVM-exception"
GCC = "GPL-3.0-or-later WITH GCC-exception-3.1"

DEBIAN = {
    "binaryen": "Apache-2.0",
    "chromium": "BSD-3-Clause",
    "chromium-driver": "BSD-3-Clause",
    "clang-19": LLVM,
    "clang-format-19": LLVM,
    "clang-tidy-19": LLVM,
    "cmake": "BSD-3-Clause",
    "cppcheck": "GPL-3.0-or-later",
    "curl": "curl",
    "doxygen": "GPL-2.0-only",
    "frama-c-base": "LGPL-2.1-only",
    "gcc-arm-none-eabi": GCC,
    "gcc-riscv64-unknown-elf": GCC,
    "libcsv-dev": "LGPL-2.1-or-later",
    "libeigen3-dev": "MPL-2.0",
    "libinih-dev": "BSD-3-Clause",
    "libjansson-dev": "MIT",
    "liblapacke-dev": "BSD-3-Clause",
    "libpopt-dev": "MIT",
    "libstdc++-arm-none-eabi-newlib": GCC,
    "lld-19": LLVM,
    "llvm-19": LLVM,
    "ninja-build": "Apache-2.0",
    "picolibc-riscv64-unknown-elf": "BSD-3-Clause",
    "pkgconf": "ISC",
    "poppler-utils": "GPL-2.0-or-later",
    "python3-venv": "PSF-2.0",
    "qemu-system-arm": "GPL-2.0-only",
    "qemu-system-misc": "GPL-2.0-only",
    "shellcheck": "GPL-3.0-or-later",
    "valgrind": "GPL-2.0-or-later",
}

_BY_LICENSE = {
    "Apache-2.0": (
        "importlib-metadata", "importlib-resources", "msgpack", "scikit-build-core",
        "selenium", "sortedcontainers", "tornado", "websocket-client",
    ),
    "Apache-2.0 OR BSD-2-Clause": ("packaging",),
    "Apache-2.0 OR BSD-3-Clause": ("python-dateutil",),
    "BSD-2-Clause": ("locket", "pygments", "tblib"),
    "BSD-3-Clause": (
        "click", "cloudpickle", "contourpy", "cycler", "dask", "distributed", "fsspec", "idna", "jinja2", "joblib",
        "kiwisolver", "lxml", "lz4", "markupsafe", "numpy", "partd", "psutil", "pycparser", "pyulog", "scipy", "toolz",
        "zict", "zstandard",
    ),
    "BSD-2-Clause OR BSD-3-Clause": ("gtsam",),
    "ISC": ("kconfiglib",),
    "LGPL-2.1-or-later": ("jsbsim",),
    "LGPL-3.0-or-later": ("pymavlink",),
    "MIT": (
        "attrs", "cffi", "exceptiongroup", "fastcrc", "fonttools", "h11", "iniconfig", "lupa", "markdown-it-py", "mcap",
        "mdurl", "narwhals", "plotly", "pluggy", "pyparsing", "pytest", "pyyaml", "rich", "ruff", "setuptools", "six",
        "tomli", "trio-websocket", "urllib3", "wsproto", "zipp",
    ),
    "MIT OR Apache-2.0": ("outcome", "sniffio", "trio"),
    "MIT-CMU": ("pillow",),
    "MPL-2.0": ("certifi", "pathspec"),
    "MPL-2.0 AND MIT": ("tqdm",),
    "PSF-2.0": ("matplotlib", "typing-extensions"),
}  # fmt: skip

PYTHON = {name: license for license, names in _BY_LICENSE.items() for name in names}

OTHERS = {"plotly.js": "MIT", "unity": "MIT"}
