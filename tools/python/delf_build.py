# SPDX-License-Identifier: MIT
"""Builds the wheel of delf by CMake (PEP 517): pip install . and pip wheel . in the root, without a network.

The wheel runs on any processor of its kind, with the same bits: DELF_NATIVE is off. Settings (pip's -C NAME=VALUE):
build-dir, an existing or new folder of CMake; native=on, for this machine alone; jobs. It links to
the system's libraries of Boost.Program_options, fmt, HDF5 and zlib: its tag is that of this machine's Linux.
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAME = "delf"


def _version():
    return re.search(r"project\(delf VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


def _metadata():
    return "\n".join([
        "Metadata-Version: 2.1", f"Name: {NAME}", f"Version: {_version()}",
        "Summary: A discrete multisymplectic lattice engine", "License: MIT", "Requires-Python: >=3.9",
        "Requires-Dist: numpy", "Provides-Extra: files", 'Requires-Dist: h5py; extra == "files"', "", ""])


def _tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def _cmake(settings):
    build = pathlib.Path(settings.get("build-dir") or ROOT / "build" / "wheel")
    native = "ON" if settings.get("native", "off") == "on" else "OFF"
    jobs = ["-j", settings["jobs"]] if "jobs" in settings else ["-j", str(os.cpu_count())]
    if "build-dir" not in settings or not (build / "CMakeCache.txt").exists():
        generator = ["-G", "Ninja"] if shutil.which("ninja") and not (build / "CMakeCache.txt").exists() else []
        options = {"CMAKE_BUILD_TYPE": "Release", "DELF_NATIVE": native, "DELF_BUILD_TESTS": "OFF", "DELF_PYTHON": "ON",
                   "Python_EXECUTABLE": sys.executable}
        subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *generator, *(f"-D{k}={v}" for k, v in options.items())],
                       check=True)
    subprocess.run(["cmake", "--build", str(build), *jobs, "--target", "python_package"], check=True)
    return build


def _about():
    """The files of the wheel that describe it."""
    return {"METADATA": _metadata().encode(),
            "WHEEL": f"Wheel-Version: 1.0\nGenerator: delf\nRoot-Is-Purelib: false\nTag: {_tag()}\n".encode(),
            "entry_points.txt": b"[console_scripts]\ndelf = delf.__main__:main\n",
            "LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    info = f"{NAME}-{_version()}.dist-info"
    os.makedirs(os.path.join(metadata_directory, info))
    for name, data in _about().items():
        pathlib.Path(metadata_directory, info, name).write_bytes(data)
    return info


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    build = _cmake(config_settings or {})
    files = {}
    package = ROOT / "tools" / "python" / "delf"
    for path in sorted(package.iterdir()):
        if path.suffix in (".py", ".pyi", ".typed"):
            files[f"delf/{path.name}"] = path.read_bytes()
    files.update({f"delf/{p.name}": p.read_bytes() for p in (build / "python" / "delf").glob("_delf*.so")})
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(["cmake", "--install", str(build), "--prefix", prefix, "--strip"], check=True,
                       stdout=subprocess.DEVNULL)
        for path in sorted(pathlib.Path(prefix).rglob("*")):
            if path.is_file():
                files[f"delf/prefix/{path.relative_to(prefix)}"] = path.read_bytes()
    info = f"{NAME}-{_version()}.dist-info"
    files.update({f"{info}/{name}": data for name, data in _about().items()})
    hashed = lambda data: base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    record = "".join(f"{name},sha256={hashed(data)},{len(data)}\n" for name, data in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"{NAME}-{_version()}-{_tag()}.whl"
    with zipfile.ZipFile(os.path.join(wheel_directory, wheel), "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            executable = name.startswith("delf/prefix/bin/") or name.endswith(".so")
            entry.external_attr = (0o100755 if executable else 0o100644) << 16  # pip reads them of regular files alone
            archive.writestr(entry, data)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    head = f"{NAME}-{_version()}"
    listed = subprocess.run(["git", "-C", str(ROOT), "ls-files"], check=True, capture_output=True, text=True).stdout
    with tarfile.open(os.path.join(sdist_directory, head + ".tar.gz"), "w:gz") as archive:
        for name in listed.splitlines():
            archive.add(ROOT / name, f"{head}/{name}")
        with tempfile.NamedTemporaryFile("w") as info:
            info.write(_metadata())
            info.flush()
            archive.add(info.name, f"{head}/PKG-INFO")
    return head + ".tar.gz"
