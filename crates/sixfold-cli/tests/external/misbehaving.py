"""An external program of a study that fails in the way that its second argument names."""

import json
import subprocess
import sys
import time

mode = sys.argv[2]


def say(answer):
    print(json.dumps(answer), flush=True)


greeting = {"protocol": 1, "holds": True, "library": "trouble 1.0", "bytes": 1000}
if mode == "refuses":
    greeting = {"protocol": 1, "holds": False, "reason": "it is Tuesday"}
elif mode == "other version":
    greeting["protocol"] = 7
elif mode == "rubbish":
    print("Segmentation fault (not really)", flush=True)
elif mode == "crashes at once":
    sys.exit("no licence found")
elif mode == "endless line":
    while True:
        sys.stdout.write("x" * 4096)
elif mode == "child that hangs":
    child = subprocess.Popen(["sleep", "1000"])
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write(str(child.pid))
    time.sleep(1000)
say(greeting)

asked = 0
for line in sys.stdin:
    asked += 1
    if mode == "hangs":
        time.sleep(1000)
    if mode == "crashes later" and asked > 6:
        sys.exit("out of luck")
    right = {"boundary": 0, "edge_length": None}[json.loads(line)["run"]]
    if right is None:
        say({"refused": "it measures\u001b[31m no lengths"})
    elif mode == "other checksum":
        say({"wall_ns": 10, "checksum": 3, "elements": 6})
    elif mode == "other elements":
        say({"wall_ns": 10, "checksum": 0, "elements": 1})
    elif mode == "wrong unit":
        say({"wall_ns": 1e18, "checksum": 0, "elements": 6})
    elif mode == "no time":
        say({"checksum": 0, "elements": 6})
    else:
        time.sleep(0.0002)
        say({"wall_ns": 200_000, "cpu_ns": 150_000, "checksum": right, "elements": 6})
        if mode == "answers twice":
            say({"wall_ns": 1, "cpu_ns": 1, "checksum": right, "elements": 6})
            time.sleep(0.05)
