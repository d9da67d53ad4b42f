# Takes steps on request. The script before it defines `begin(crowd, setting)`, which places the
# agents and returns two functions: one takes a number of steps, the other returns all positions.
#
# Arguments: a file with one agent per line (x, y, radius, x and y of the goal), and the setting as
# JSON. Prints "ready". Then, for each line on stdin with a number of steps, takes that many steps
# and prints the seconds that they took and the mean distance of the agents from where they began.

import json
import math
import sys
import time
import types

with open(sys.argv[1], encoding="ascii") as people:
    crowd = [tuple(map(float, line.split())) for line in people]
walk, places = begin(crowd, types.SimpleNamespace(**json.loads(sys.argv[2])))
first = places()
print("ready", flush=True)
for line in sys.stdin:
    start = time.perf_counter()
    walk(int(line))
    seconds = time.perf_counter() - start
    print(seconds, sum(map(math.dist, first, places())) / len(first), flush=True)
