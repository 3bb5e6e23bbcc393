"""A campaign of hostile files, by hand: ``python tests/fuzz/campaign.py --target obj --count 1000``.

Files are made by grammars (fuzz_meshes, fuzz_molecules, fuzz_scenes, fuzz_drawings), damaged, and given to a
reader or a verb; fuzz_oracle judges.
Each cause is printed once, with the seed that shows it again; --keep FOLDER keeps the smallest file of each.

    campaign.py                            all targets, a minute of CPU each
    campaign.py --minutes 60 --seed night  as long as you like, another stream of files
    campaign.py --target paint --show 17   the file of one attack, on stdout
    campaign.py --atheris obj corpus/      guided by coverage, where atheris is installed (it is not needed)

test_fuzz.py runs a short, fixed part of this with the other tests.
"""

from __future__ import annotations

import argparse
import itertools
import resource
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz.fuzz_oracle import FILES, TARGETS, Finding, attack, attacks, judged

MEMORY_BYTES = 3 << 30
"""A campaign gets no more memory than this; what needs more is a finding."""


def main() -> int:
    """Run what the command line asks for; 1 if anything was found."""
    options = _options()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))
    if options.atheris:
        return _guided(*options.atheris)
    targets = options.target or TARGETS
    if options.show is not None:
        with TemporaryDirectory() as folder:
            sys.stdout.buffer.write(attack(targets[0], f"{options.seed} {options.show}", Path(folder))[1])
        return 0
    causes = [_campaign(target, options) for target in targets]
    return int(any(causes))


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--target", action="append", choices=TARGETS, help="what to attack (may stand several times)")
    parser.add_argument("--minutes", type=float, default=1.0, help="CPU time for each target")
    parser.add_argument("--count", type=int, default=1 << 60, help="inputs for each target")
    parser.add_argument("--seed", default="0", help="which stream of files")
    parser.add_argument("--start", type=int, default=0, help="where in the stream to begin")
    parser.add_argument("--show", type=int, help="write the file of one number of the stream to stdout")
    parser.add_argument("--keep", type=Path, help="folder for the smallest file of each cause")
    parser.add_argument(
        "--atheris", nargs=2, metavar=("TARGET", "CORPUS"), help="coverage-guided mutation of one target"
    )
    return parser.parse_args()


def _campaign(target: str, options: argparse.Namespace) -> int:
    """Attack one target, print what was found, and return how many causes."""
    smallest: dict[str, bytes] = {}
    slowest, count = (0.0, ""), 0
    start = time.process_time()
    seeds = (f"{options.seed} {number}" for number in itertools.count(options.start))
    # What stops it early, Ctrl-C or a time limit of the shell, still gets the counts.
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    with suppress(KeyboardInterrupt):
        for seed, found, data, suffix, seconds in attacks(target, itertools.islice(seeds, options.count)):
            count += 1
            slowest = max(slowest, (seconds, seed))
            if found is not None:
                _note(target, seed, found, data, suffix, smallest, options.keep)
            if time.process_time() - start > 60.0 * options.minutes:
                break
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"{target}: {count} inputs in {time.process_time() - start:.0f} s, {len(smallest)} causes;"
          f" slowest {slowest[0]:.2f} s (seed '{slowest[1]}'), peak {peak:.0f} MB", flush=True)  # fmt: skip
    return len(smallest)


def _note(
    target: str, seed: str, found: Finding, data: bytes, suffix: str, smallest: dict[str, bytes], keep: Path | None
) -> None:
    """Print a cause that is new; keep its file where it is the smallest so far."""
    if found.cause not in smallest:
        print(f"{target}, seed '{seed}', {len(data)} bytes: {found.cause}", flush=True)
    elif len(data) >= len(smallest[found.cause]):
        return
    smallest[found.cause] = data
    if keep is not None:
        keep.mkdir(parents=True, exist_ok=True)
        stem = "".join(letter if letter.isalnum() else "_" for letter in f"{target}_{found.cause}")[:100]
        (keep / f"{stem}.{suffix}").write_bytes(data)
        (keep / f"{stem}.story").write_text(f"seed {seed}\n{found.story}")


def _guided(target: str, corpus: str) -> int:
    """Mutation guided by coverage, without end: https://github.com/google/atheris."""
    import atheris

    folder = TemporaryDirectory()

    def test(data: bytes) -> None:
        found = judged(target, data, target if target in FILES else "scene", Path(folder.name))
        if found is not None:
            raise AssertionError(found.story)

    place = Path(corpus)
    place.mkdir(parents=True, exist_ok=True)
    for number in range(200):
        (place / f"seed{number}").write_bytes(attack(target, f"{Random(0).random()} {number}", Path(folder.name))[1])
    atheris.instrument_all()
    atheris.Setup([sys.argv[0], corpus], test)
    atheris.Fuzz()
    return 0


if __name__ == "__main__":
    sys.exit(main())
