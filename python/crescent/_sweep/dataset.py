"""The results as an Arrow dataset in Parquet: ``data/*.parquet``, one file a result, one row a number.

docs/clusters.md lists the columns. A file whose name begins with "_" is no part of the dataset for any reader.
"""

from __future__ import annotations

import csv
import io
import json
import os
import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .store import read_json, write_whole

COLUMNS = (
    "point", "arm", "sampler", "n", "s", "seed", "metric", "region", "value", "experiment", "sampler_id", "version",
    "worker", "host", "isa", "suspect",
)  # fmt: skip


def _column(values: Sequence[Any]) -> Any:
    """An Arrow type for the values of a swept key: lists are JSON texts."""
    import pyarrow as pa  # type: ignore[import-untyped,import-not-found,unused-ignore]

    kinds = {type(value) for value in values}
    if kinds == {bool}:
        return pa.bool_()
    if kinds <= {int}:
        return pa.int64()
    if kinds <= {int, float}:
        return pa.float64()
    return pa.string()


def _at_equal_time(rows: Sequence[Mapping[str, str]], times: Sequence[Sequence[Any]]) -> list[dict[str, str]]:
    """Rows with the seconds of N samples of all pixels on one thread, the median over the seeds of the result, and the
    efficiency at equal time, 1 / (variance times seconds of a pixel)."""
    out: list[dict[str, str]] = []
    for s in {float(row[2]) for row in times}:
        seconds = statistics.median(row[4] / row[1] for row in times if float(row[2]) == s)
        a_sample = statistics.median(row[4] / row[3] for row in times if float(row[2]) == s)
        of_s = [row for row in rows if row["s"] and float(row["s"]) == s]
        for n, seed in dict.fromkeys((row["n"], row["seed"]) for row in of_s):
            first = next(row for row in of_s if (row["n"], row["seed"]) == (n, seed))
            out.append({**first, "metric": "seconds", "region": "", "value": repr(seconds * int(n))})
        for row in of_s:
            if row["metric"] == "var" and row["value"] and float(row["value"]) > 0:
                value = 1 / (float(row["value"]) * a_sample * int(row["n"]))
                out.append({**row, "metric": "efficiency_time", "value": repr(value)})
    return out


class Dataset:
    """The folder ``data``. `axes`: the values of each swept key over all points, which decide its type."""

    def __init__(self, out: Path, axes: Mapping[str, Sequence[Any]]) -> None:
        import pyarrow as pa  # type: ignore[import-untyped,import-not-found,unused-ignore]

        self.folder = out / "data"
        self._types = {path: _column(values) for path, values in axes.items()}
        text, real, whole = pa.string(), pa.float64(), pa.int64()
        own = {"n": whole, "s": real, "seed": whole, "value": real, "suspect": pa.bool_()}
        self.schema = pa.schema([*self._types.items(), *((name, own.get(name, text)) for name in COLUMNS)])
        state = {"schema": [[field.name, str(field.type)] for field in self.schema]}
        if read_json(self.folder / "_schema.json") != state:
            self.clear()
            write_whole(self.folder / "_schema.json", json.dumps(state))

    def clear(self) -> None:
        """Removes every file: they are regenerated from the results."""
        for path in self.folder.glob("*.parquet"):
            path.unlink()

    def names(self) -> set[str]:
        """The files that are there."""
        return {path.name for path in self.folder.glob("*.parquet")}

    def remove(self, name: str) -> None:
        """Removes a file."""
        (self.folder / name).unlink(missing_ok=True)

    def write(self, name: str, point: Mapping[str, Any], result: Mapping[str, Any], suspect: bool) -> None:
        """Writes the rows of one result; `point`: its swept values under "values", and its constant columns."""
        import pyarrow as pa  # type: ignore[import-untyped,import-not-found,unused-ignore]
        import pyarrow.parquet as parquet  # type: ignore[import-untyped,import-not-found,unused-ignore]

        rows = list(csv.DictReader(io.StringIO(result["csv"], newline="")))
        rows += _at_equal_time(rows, result.get("times", []))
        count = len(rows)

        def number(text: str) -> float | None:
            value = float(text) if text else float("nan")
            return None if value != value else value

        columns: dict[str, Any] = {}
        for path, kind in self._types.items():
            value = point["values"][path]
            if kind == pa.string() and not isinstance(value, str):
                value = json.dumps(value)
            columns[path] = [value] * count
        columns |= {
            "arm": [row["arm"] for row in rows],
            "n": [int(row["n"]) for row in rows],
            "s": [number(row["s"]) for row in rows],
            "seed": [int(row["seed"]) for row in rows],
            "metric": [row["metric"] for row in rows],
            "region": [row["region"] for row in rows],
            "value": [number(row["value"]) for row in rows],
            "suspect": [suspect] * count,
        }
        for name_ in ("point", "sampler", "sampler_id"):
            columns[name_] = [point[name_]] * count
        for name_ in ("experiment", "version", "worker", "host", "isa"):
            columns[name_] = [result[name_]] * count
        table = pa.table([pa.array(columns[f.name], f.type) for f in self.schema], schema=self.schema)
        buffer = io.BytesIO()
        parquet.write_table(table, buffer, compression="zstd")
        write_whole(self.folder / name, buffer.getvalue())


def read(out: str | os.PathLike[str]) -> Any:
    """The dataset of a sweep as a pyarrow.Table."""
    import pyarrow.dataset as dataset  # type: ignore[import-untyped,import-not-found,unused-ignore]

    files = sorted(str(path) for path in (Path(out) / "data").glob("*.parquet"))
    if not files:
        raise ValueError(f"{os.fspath(out)}: no results of a sweep: expected a folder with data/*.parquet")
    return dataset.dataset(files).to_table()
