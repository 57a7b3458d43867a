"""run.py FOLDER FLAGS TEST...: mutates the library's sources, one change at a time, and counts which changes the tests
(given as tests/unit/math/pose_test) notice. See tests/verify/mutation for what is asked of the numbers, and the settings."""

import os
import sys
from concurrent.futures import ThreadPoolExecutor

from builder import Builder
from campaign import Campaign, Judge, Test
from records import Results, Survivors

LEAST_RATE = 0.97
LIST = "tests/verify/mutants/survivors"


def rate_of(numbers):
    """Of those that something can notice: killed."""
    _, _, differ, killed, listed = numbers
    return killed / (differ - listed) if differ > listed else 1


def row(name, numbers):
    generated, compiled, differ, killed, listed = numbers
    rate = f"{100 * rate_of(numbers):6.2f} %"
    print(f"{name:28}{generated:8}{compiled:9}{differ:8}{killed:8}{listed:8}  {rate}", flush=True)


def sources(builder):
    headers = sorted({os.path.join(os.path.dirname(path), name) for path in builder.sources
                      for name in os.listdir(os.path.dirname(path)) if name.endswith(".h")})
    wanted = os.environ.get("FILES", "").split()
    unknown = set(wanted) - set(builder.sources + headers)
    if unknown:
        sys.exit(f"mutation: no source of the library: {' '.join(sorted(unknown))}")
    return [path for path in builder.sources + headers if not wanted or path in wanted]


def report(campaign):
    row(campaign.source.path, campaign.numbers())
    for mutant in campaign.survivors:
        print("survives: " + mutant.show(), flush=True)
    for entry in campaign.stale:
        print(f"{LIST}: not needed: {entry}", flush=True)


def load_test(builder, folder, name):
    reached = builder.reached_from(os.path.join(folder, "obj", name + ".o"))
    test = Test(os.path.join(folder, "run", name.replace("/", "_")), reached)
    test.measure(builder.originals)
    return test


def main():
    folder, flags, *names = sys.argv[1:]
    wanted = os.environ.get("SAMPLE", "60")
    sample = None if wanted == "all" else int(wanted)
    seed = os.environ.get("SEED", "20240229")
    builder = Builder(folder, os.environ.get("CC", "cc"), flags)
    survivors = Survivors(LIST)
    campaigns = []
    with ThreadPoolExecutor(int(os.environ.get("JOBS", os.cpu_count()))) as pool:
        judge = Judge([load_test(builder, folder, name) for name in names])
        results = Results(os.path.join(folder, "results"))
        print(f"SAMPLE={wanted} SEED={seed}")
        print(f"{'':28} mutants  compile  differ  killed  listed      rate")
        for path in sources(builder):
            campaign = Campaign(path, (builder, judge, results, survivors, pool), sample, seed)
            campaign.run()
            if campaign.differing:
                campaigns.append(campaign)
                report(campaign)
    totals = [sum(column) for column in zip(*(campaign.numbers() for campaign in campaigns))]
    row("all", totals)
    if rate_of(totals) < LEAST_RATE:
        sys.exit(f"mutation: less than {100 * LEAST_RATE:.0f} % are killed")
    if any(campaign.stale for campaign in campaigns):
        sys.exit(f"mutation: {LIST} lists what is not needed")


if __name__ == "__main__":
    main()
