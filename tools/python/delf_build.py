# SPDX-License-Identifier: MIT
"""Builds the wheel of delf by CMake (PEP 517): pip install . and pip wheel . in the root, without a network.

The wheel runs on any processor of its kind, with the same bits: DELF_NATIVE is off. Of x86-64 it holds the module and the
program twice, for any processor and for those with AVX2, and delf/_processor.py chooses; headers and libraries are those for
any. Settings (pip's -C NAME=VALUE): build-dir, a folder for the builds, or an existing build tree, of which the wheel is
made alone; native=on, one build for this machine alone; jobs. It links to the system's libraries of Boost.Program_options,
fmt, HDF5 and zlib: its tag is that of this machine's Linux.
"""
import base64
import hashlib
import os
import pathlib
import platform
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


def _levels(settings):
    """The builds of a wheel, the one whose headers and libraries it has first, with their flags of the compiler."""
    if settings.get("native", "off") == "on":
        return {"native": None}
    if platform.machine() == "x86_64":
        # gcc 12 fuses products of complex numbers, whatever -ffp-contract says
        return {"x86-64": "", "x86-64-v3": "-march=x86-64-v3 -mno-fma"}
    return {platform.machine(): ""}


def _configured(build, flags):
    generator = ["-G", "Ninja"] if shutil.which("ninja") and not (build / "CMakeCache.txt").exists() else []
    options = {"CMAKE_BUILD_TYPE": "Release", "DELF_NATIVE": "ON" if flags is None else "OFF",
               "CMAKE_CXX_FLAGS": f"{os.environ.get('CXXFLAGS', '')} {flags or ''}".strip(),
               "DELF_BUILD_TESTS": "OFF", "DELF_PYTHON": "ON",
               "DELF_UNITY": "ON", "Python_EXECUTABLE": sys.executable}
    subprocess.run(["cmake", "-S", str(ROOT), "-B", str(build), *generator,
                    *(f"-D{name}={value}" for name, value in options.items())], check=True)
    return build


def _built(settings):
    """The trees of the wheel's builds, by their levels."""
    root = pathlib.Path(settings.get("build-dir") or ROOT / "build" / "wheel")
    if "build-dir" in settings and (root / "CMakeCache.txt").exists():
        trees = {"": root}
    else:
        trees = {level: _configured(root / level, flags) for level, flags in _levels(settings).items()}
    for build in trees.values():
        subprocess.run(["cmake", "--build", str(build), "-j", settings.get("jobs", str(os.cpu_count())),
                        "--target", "python_package"], check=True)
    return trees


def _module(build):
    """The name and the contents of the module of a build, without the names of what it does not export."""
    (path,) = (build / "python" / "delf").glob("_delf*.so")
    with tempfile.TemporaryDirectory() as folder:
        copy = shutil.copy(path, folder)
        if shutil.which("strip"):
            subprocess.run(["strip", copy], check=True)
        return path.name, pathlib.Path(copy).read_bytes()


def _installed(build):
    """What a build installs: paths below the prefix, with contents."""
    with tempfile.TemporaryDirectory() as prefix:
        subprocess.run(["cmake", "--install", str(build), "--prefix", prefix, "--strip"], check=True,
                       stdout=subprocess.DEVNULL)
        return {str(path.relative_to(prefix)): path.read_bytes() for path in sorted(pathlib.Path(prefix).rglob("*"))
                if path.is_file()}


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
    first, *others = _built(config_settings or {}).items()
    files = {}
    package = ROOT / "tools" / "python" / "delf"
    for path in sorted(package.iterdir()):
        if path.suffix in (".py", ".pyi", ".typed"):
            files[f"delf/{path.name}"] = path.read_bytes()
    files.update({f"delf/prefix/{name}": data for name, data in _installed(first[1]).items()})
    for level, build in (("", first[1]), *others):
        folder = f"delf/{level}/" if level else "delf/"
        name, module = _module(build)
        files[folder + name] = module
        if level:
            files[folder + "bin/delf"] = _installed(build)["bin/delf"]
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
            executable = "/bin/" in name or name.endswith(".so")
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
