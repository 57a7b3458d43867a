import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "lib" / "python"))
pytest_plugins = ["waferhand.pytest_plugin"]
