#!/usr/bin/env bash
# Builds the library for WebAssembly (src/web) and has a browser render the crystal ball with it. The seven pictures must have
# the bits of this machine's own, which must have the checksums that the page knows.
#
#   tests/wasm.sh SHEAF [PICTURE]      SHEAF: the command; PICTURE: where a picture of the page goes
#
# Debian: emscripten node-acorn chromium libglm-dev libfmt-dev libhwy-dev nlohmann-json3-dev. Exits with 77 where they are not installed.
set -euo pipefail
sheaf=$(realpath "$1")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
for tool in emcmake chromium python3 ninja; do
  command -v $tool >/dev/null || { echo "skipped: no $tool" >&2; exit 77; }
done
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}

emcmake cmake -S src/web -B build/web -G Ninja >build/web.log 2>&1 || { cat build/web.log >&2; exit 1; }
cmake --build build/web --parallel "$(nproc)"

work=$(mktemp -d)
trap 'rm -rf "$work"; [[ -z ${server:-} ]] || kill "$server" 2>/dev/null || true' EXIT
"$sheaf" render scenes/crystal-ball.json --views seven --size 640x480 -q -o "$work/{camera}.pfm"

# Serves the page, and takes what it reports.
cat >"$work/serve.py" <<'END'
import functools, http.server, pathlib, sys

work = pathlib.Path(sys.argv[1])

class Handler(http.server.SimpleHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        (work / "part.json").write_bytes(body)
        (work / "part.json").rename(work / "report.json")
        self.send_response(204)
        self.end_headers()
    def log_message(self, *_):
        pass

server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory="build/web"))
(work / "port").write_text(str(server.server_port))
server.serve_forever()
END
python3 "$work/serve.py" "$work" &
server=$!
for ((i = 0; i < 100; ++i)); do [[ ! -s $work/port ]] || break; sleep 0.1; done
page=http://127.0.0.1:$(cat "$work/port")/crystal-ball.html

browser=(chromium --headless=new --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$work/profile")
timeout 300 "${browser[@]}" --remote-debugging-port=0 "$page#report" >"$work/browser.log" 2>&1 &
tab=$!
for ((i = 0; i < 280; ++i)); do [[ ! -e $work/report.json ]] || break; sleep 1; done
kill "$tab" 2>/dev/null || true
wait "$tab" 2>/dev/null || true
[[ -e $work/report.json ]] || { cat "$work/browser.log" >&2; echo "the page reports nothing" >&2; exit 1; }
if [[ -n ${2:-} ]]; then
  # The page's clock stands still meanwhile: it tells no time.
  "${browser[@]}" --window-size=720,860 --virtual-time-budget=20000 --screenshot="$(realpath "$2")" "$page" >/dev/null 2>&1
fi

# The checksum is FNV-1a of 64 bits over the floats, rows from the top; a .pfm has them from below.
python3 - "$work" <<'END'
import json, pathlib, sys

work = pathlib.Path(sys.argv[1])
report = json.loads((work / "report.json").read_text())
known = dict(line.split() for line in pathlib.Path("src/web/checksums.txt").read_text().splitlines())

def checksum(path):
    _, size, _, body = path.read_bytes().split(b"\n", 3)
    row, rows = 12 * int(size.split()[0]), int(size.split()[1])
    assert len(body) == row * rows
    value = 0xCBF29CE484222325
    for y in reversed(range(rows)):
        for byte in body[row * y : row * (y + 1)]:
            value = (value ^ byte) * 0x100000001B3 & 0xFFFFFFFFFFFFFFFF
    return f"{value:016x}"

native = {path.stem: checksum(path) for path in work.glob("*.pfm")}
assert len(native) == 7, native
wrong = [name for name in native if not native[name] == report["views"].get(name) == known.get(name)]
for name in sorted(native):
    print(f"{name}: here {native[name]}, page {report['views'].get(name)}, stored {known.get(name)}")
rates = report["rates"]
print(f"{report['target']}: {rates['simd']:.1f} frames a second, without SIMD {rates['scalar']:.1f}; {report['agent']}")
sys.exit(f"other bits: {', '.join(wrong)}" if wrong or report["verdict"] != "the same bits" else 0)
END
