"""A folder of pictures to Parquet on Ray: python examples/fit_folder_ray.py FOLDER OUT [ADDRESS]

Without an address on this machine; with one (`auto`, `ray://head:10001`) on that cluster, whose machines must all see both folders.
Run it again after a break: it goes on where it stopped.
"""

import sys
from pathlib import Path

import ray

import dvp.ray


def main(folder: str, out: str, address: str | None = None) -> dict[str, int]:
    ray.init(address=address, log_to_driver=False)
    pictures = sorted(str(path.absolute()) for path in Path(folder).glob("*.png"))
    done = dvp.ray.fit_to_parquet(pictures, Path(out).absolute(), shard=100)
    print(f"{done['made']} of {done['shards']} shards made, {done['rows']} rows written to {out}")
    return done


if __name__ == "__main__":
    main(*sys.argv[1:])
