"""Builds the package's wheel with the standard library alone, so that pip needs no network for it (PEP 517 and 660)."""

from __future__ import annotations

import base64
import hashlib
import pathlib
import re
import tarfile
import zipfile

HERE = pathlib.Path(__file__).resolve().parent


def field(name: str) -> str:
    found = re.search(rf'^{name} = "([^"]*)"$', (HERE / "pyproject.toml").read_text("utf-8"), re.M)
    if not found:
        raise ValueError(f"pyproject.toml: no {name}")
    return found[1]


def metadata() -> dict[str, bytes]:
    info = f"{field('name')}-{field('version')}.dist-info"
    about = (
        f"Metadata-Version: 2.1\nName: {field('name')}\nVersion: {field('version')}\nSummary: {field('description')}\n"
        f"Requires-Python: {field('requires-python')}\n"
    )
    return {
        f"{info}/METADATA": about.encode(),
        f"{info}/WHEEL": b"Wheel-Version: 1.0\nGenerator: waferhand\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
        f"{info}/entry_points.txt": b"[pytest11]\nwaferhand = waferhand.pytest_plugin\n",
    }


def write_wheel(folder: str, files: dict[str, bytes]) -> str:
    name = f"{field('name')}-{field('version')}-py3-none-any.whl"
    record = f"{field('name')}-{field('version')}.dist-info/RECORD"
    lines = []
    with zipfile.ZipFile(pathlib.Path(folder) / name, "w", zipfile.ZIP_DEFLATED) as wheel:
        for path, data in sorted(files.items()):
            wheel.writestr(zipfile.ZipInfo(path), data)
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            lines.append(f"{path},sha256={digest},{len(data)}")
        wheel.writestr(zipfile.ZipInfo(record), "\n".join([*lines, f"{record},,", ""]))
    return name


def sources() -> dict[str, bytes]:
    paths = [*HERE.glob("waferhand/*.py"), HERE / "waferhand" / "py.typed"]
    return {path.relative_to(HERE).as_posix(): path.read_bytes() for path in paths}


def build_wheel(wheel_directory: str, config_settings: object = None, metadata_directory: object = None) -> str:
    return write_wheel(wheel_directory, {**sources(), **metadata()})


def build_editable(wheel_directory: str, config_settings: object = None, metadata_directory: object = None) -> str:
    return write_wheel(wheel_directory, {"waferhand.pth": f"{HERE}\n".encode(), **metadata()})


def build_sdist(sdist_directory: str, config_settings: object = None) -> str:
    name = f"{field('name')}-{field('version')}"
    with tarfile.open(pathlib.Path(sdist_directory) / f"{name}.tar.gz", "w:gz") as archive:
        for path in ["pyproject.toml", "backend.py", *sources()]:
            archive.add(HERE / path, f"{name}/{path}")
    return f"{name}.tar.gz"
