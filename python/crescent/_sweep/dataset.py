"""The results of a sweep in Parquet: a file for each result, a row for each number. docs/clusters.md lists the columns.

The metadata of a file have what no row has, such as the text of metrics.json, as compressed JSON. A file is named by the
identity of its result and by the checksum of its bytes, so that one that is truncated or changed is recognised.
"""

from __future__ import annotations

import base64
import csv
import hashlib
import io
import json
import os
import statistics
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .store import write_whole

COLUMNS = {
    "point": "string", "arm": "string", "sampler": "string", "n": "int64", "s": "double", "seed": "int64",
    "metric": "string", "region": "string", "value": "double", "experiment": "string", "sampler_id": "string",
    "version": "string", "worker": "string", "host": "string", "isa": "string", "suspect": "bool",
}  # fmt: skip

Row = Mapping[str, Any]


def _type(values: Sequence[Any]) -> str:
    """The Arrow type for the values of a swept key: lists are JSON texts."""
    kinds = {type(value) for value in values}
    if kinds == {bool}:
        return "bool"
    if kinds <= {int}:
        return "int64"
    return "double" if kinds <= {int, float} else "string"


def _at_equal_time(rows: Sequence[Mapping[str, str]], times: Sequence[Sequence[Any]]) -> Iterator[dict[str, str]]:
    """Rows with the seconds of N samples of all pixels on one thread, the median over the seeds of the result, and the
    efficiency at equal time, 1 / (variance times seconds of a pixel)."""
    for s in {float(row[2]) for row in times}:
        seconds = statistics.median(row[4] / row[1] for row in times if float(row[2]) == s)
        seconds_of_pixel = statistics.median(row[4] / row[3] for row in times if float(row[2]) == s)
        of_s = [row for row in rows if row["s"] and float(row["s"]) == s]
        for row in {(row["n"], row["seed"]): row for row in reversed(of_s)}.values():
            yield {**row, "metric": "seconds", "region": "", "value": repr(seconds * int(row["n"]))}
        for row in of_s:
            if row["metric"] == "var" and row["value"] and float(row["value"]) > 0:
                value = 1 / (float(row["value"]) * seconds_of_pixel * int(row["n"]))
                yield {**row, "metric": "efficiency_time", "value": repr(value)}


def rows_of_part(table: str, times: Sequence[Sequence[Any]]) -> list[Row]:
    """The rows of a metrics.csv, and those of its times."""

    def number(text: str) -> float | None:
        value = float(text) if text else float("nan")
        return None if value != value else value

    rows = list(csv.DictReader(io.StringIO(table, newline="")))
    return [
        {**row, "n": int(row["n"]), "seed": int(row["seed"]), "s": number(row["s"]), "value": number(row["value"])}
        for row in [*rows, *_at_equal_time(rows, times)]
    ]


class Stored(NamedTuple):
    """A file with a result."""

    path: Path
    has_columns: bool  #: whether its columns are those of the dataset
    suspect: bool
    worker: str


def _identity(name: str) -> str:
    """What the files of one result share: SCENE-ARM-FIRST-LAST of SCENE-ARM-FIRST-LAST-POINT; of a check all."""
    return "-".join(name.split("-")[:4])


def _group(name: str) -> str:
    """SCENE-ARM of a name; of a check all."""
    return "-".join(name.split("-")[:2])


class Results:
    """Results by name: in ``data`` those of the points of the sweep, in ``store/results`` those of other points.

    The name of a part is SCENE-ARM-FIRST-LAST-POINT: an arm at a scene, a block of seeds, the point of the rows. `axes`:
    the values of each swept key over all points, which decide its type. `pattern`: of the files that are read.
    """

    def __init__(
        self, out: Path, axes: Mapping[str, Sequence[Any]], columns: Mapping[str, str] = COLUMNS, pattern: str = "*"
    ) -> None:
        import pyarrow as pa  # type: ignore[import-untyped,import-not-found,unused-ignore]

        self._data, self._others = out / "data", out / "store" / "results"
        self._columns = columns
        self._axes = {path: f"values.{path}" if path in columns else path for path in axes}
        types = {**{self._axes[path]: _type(values) for path, values in axes.items()}, **columns}
        self._schema = pa.schema([(name, pa.type_for_alias(kind)) for name, kind in types.items()])
        self._groups: dict[str, dict[str, Stored]] = {}
        self._blocks: dict[tuple[str, bool], list[tuple[int, int]]] = {}
        self._forgotten: set[Path] = set()
        for folder in (self._others, self._data):  # of two files of one name that in `data` counts
            for path in folder.glob(f"{pattern}.parquet"):
                if (data := _whole_bytes(path)) is not None:
                    self._set(path.stem.rpartition("-")[0], path, data)

    def _set(self, name: str, path: Path, data: bytes) -> None:
        import pyarrow.parquet as parquet  # type: ignore[import-untyped,import-not-found,unused-ignore]

        schema = parquet.read_schema(io.BytesIO(data))
        entry = Stored(path, schema.equals(self._schema), b"suspect" in schema.metadata, schema.metadata[b"worker"].decode())
        self._groups.setdefault(_group(name), {})[name] = entry
        self._forget_blocks(_group(name))

    def _forget_blocks(self, group: str) -> None:
        self._blocks.pop((group, False), None)
        self._blocks.pop((group, True), None)

    def _items(self) -> list[tuple[str, Stored]]:
        return [item for group in self._groups.values() for item in group.items()]

    def find(self, name: str) -> Stored | None:
        """The file of a name."""
        return self._groups.get(_group(name), {}).get(name)

    def blocks(self, scene: str, arm: str, suspect: bool = False) -> list[tuple[int, int]]:
        """The blocks of seeds that are there, ascending; `suspect`: also those that are suspect."""
        group = f"{scene}-{arm}"
        if (group, suspect) not in self._blocks:  # many points share the arms that are not swept
            entries = self._groups.get(group, {}).items()
            names = (name.split("-") for name, entry in entries if suspect or not entry.suspect)
            self._blocks[group, suspect] = sorted({(int(first), int(last)) for _, _, first, last, _ in names})
        return self._blocks[group, suspect]

    def text(self, scene: str, arm: str, first: int, last: int) -> str:
        """The metrics.json of a block that is there."""
        group = self._groups[f"{scene}-{arm}"].items()
        block = f"{scene}-{arm}-{first}-{last}"
        return str(self.about(next(e for name, e in group if _identity(name) == block and not e.suspect))["json"])

    def about(self, entry: Stored) -> dict[str, Any]:
        """What the metadata of a file have."""
        import pyarrow.parquet as parquet  # type: ignore[import-untyped,import-not-found,unused-ignore]

        packed = parquet.read_schema(entry.path).metadata[b"crescent"]
        return dict(json.loads(zlib.decompress(base64.b64decode(packed))))

    def add(self, name: str, rows: Sequence[Row], constants: Row, about: Row, suspect: bool = False) -> Path:
        """Writes a result in place of an earlier one. `constants`: swept keys and other columns with one value, in place
        of those in rows; `about`: what is kept besides, with the worker."""
        import pyarrow as pa  # type: ignore[import-untyped,import-not-found,unused-ignore]
        import pyarrow.parquet as parquet  # type: ignore[import-untyped,import-not-found,unused-ignore]

        constants = {self._axes.get(column, column): value for column, value in constants.items()}
        if self._columns is COLUMNS:
            constants["suspect"] = suspect
        arrays = []
        for field in self._schema:
            values = [constants.get(field.name, row.get(field.name)) for row in rows]
            if field.type == pa.string():
                values = [v if isinstance(v, str) or v is None else json.dumps(v) for v in values]
            arrays.append(pa.array(values, field.type))
        packed = base64.b64encode(zlib.compress(json.dumps(about).encode()))
        metadata = {"crescent": packed, "worker": about["worker"], **({"suspect": "true"} if suspect else {})}
        buffer = io.BytesIO()
        with parquet.ParquetWriter(buffer, self._schema, compression="zstd", store_schema=False) as writer:
            writer.write_table(pa.table(arrays, schema=self._schema))
            writer.add_key_value_metadata(metadata)
        data = buffer.getvalue()
        path = self._data / f"{name}-{_checksum(data)}.parquet"
        write_whole(path, data)
        earlier = self.find(name)
        if earlier is not None and earlier.path != path:
            earlier.path.unlink(missing_ok=True)
        self._set(name, path, data)
        return path

    def _add_again(self, name: str, entry: Stored, constants: Row, suspect: bool) -> None:
        """Writes the rows of a file once more, with other constants."""
        import pyarrow.parquet as parquet  # type: ignore[import-untyped,import-not-found,unused-ignore]

        rows = parquet.read_table(entry.path, partitioning=None).to_pylist()
        self.add(name, rows, constants, self.about(entry), suspect)

    def mark(self, workers: set[str]) -> None:
        """Marks the results of workers as suspect: the next call computes them again."""
        for name, entry in self._items():
            if entry.worker in workers:
                self._add_again(name, entry, {}, suspect=True)

    def forget(self, scene: str, arm: str) -> None:
        """Leaves out the results of an arm at a scene, whose files sync() removes."""
        self._forget_blocks(f"{scene}-{arm}")
        self._forgotten |= {entry.path for entry in self._groups.pop(f"{scene}-{arm}", {}).values()}

    def sync(self, wanted: Mapping[str, Row]) -> None:
        """Makes ``data`` agree with the points of the sweep: `wanted` are the names of their results, with the columns
        of their points. Files of other points are moved; those that are damaged or forgotten are removed."""
        same_results: dict[str, list[Stored]] = {}
        for other, stored in self._items():
            same_results.setdefault(_identity(other), []).append(stored)
        for name, constants in wanted.items():
            entry = self.find(name)
            same = same_results[_identity(name)]
            sound = next((e for e in same if not e.suspect), None)
            if entry is None or entry.path.parent != self._data or not entry.has_columns or (entry.suspect and sound):
                source = sound or entry or same[0]
                self._add_again(name, source, constants, source.suspect)
        for path in (*self._data.glob("*.parquet"), *self._others.glob("*.parquet")):
            name = path.stem.rpartition("-")[0]
            entry = self.find(name)
            if entry is None or entry.path != path:  # a whole one may be new: of a task of --engine commands
                if entry is not None or path in self._forgotten or _whole_bytes(path) is None:
                    path.unlink()
            elif name not in wanted and path.parent == self._data:
                self._others.mkdir(parents=True, exist_ok=True)
                moved = path.replace(self._others / path.name)
                self._groups[_group(name)][name] = entry._replace(path=moved)


def _checksum(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def _whole_bytes(path: Path) -> bytes | None:
    """The bytes of a file; None if they are not those that were written."""
    data = path.read_bytes()
    return data if path.stem.rpartition("-")[2] == _checksum(data) else None


def read(out: str | os.PathLike[str]) -> Any:
    """The dataset of a sweep as a pyarrow.Table."""
    import pyarrow.dataset as dataset  # type: ignore[import-untyped,import-not-found,unused-ignore]

    files = sorted(str(path) for path in (Path(out) / "data").glob("*.parquet"))
    if not files:
        raise ValueError(f"{os.fspath(out)}: no results of a sweep: expected a folder with data/*.parquet")
    return dataset.dataset(files).to_table().replace_schema_metadata(None)
