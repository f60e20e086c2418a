"""Frames of a Dask cluster's processes are those of one process, and a killed worker loses none."""

import sys
from pathlib import Path

import pytest

pytest.importorskip("distributed")

sys.path.insert(0, str(Path(__file__).parent.parent / "examples"))


def test_a_killed_worker_loses_nothing(tmp_path, capsys, monkeypatch):
    import dask_frames

    num = 24
    monkeypatch.setattr(dask_frames, "AT_ONCE", 2)
    assert dask_frames.run(tmp_path, num, 3, kills=True) == num
    assert "killed worker" in capsys.readouterr().out
    assert sorted(path.stem for path in tmp_path.glob("*.npz")) == [f"{seed:06}" for seed in range(num)]
    dask_frames.check(tmp_path, num)
    # What would not be noticed is worth nothing.
    (tmp_path / "000007.npz").write_bytes((tmp_path / "000008.npz").read_bytes())
    with pytest.raises(SystemExit, match="frame 7 is not"):
        dask_frames.check(tmp_path, num)
