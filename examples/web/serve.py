# SPDX-License-Identifier: MIT
# python3 serve.py FOLDER PORT: serves a folder to this machine alone. The two headers that isolate the page let it read
# clocks to 5 us, which are 100 us otherwise, and a file that was built anew is fetched anew.
import functools
import http.server
import sys

HEADERS = {
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cache-Control": "no-cache",
}


class Handler(http.server.SimpleHTTPRequestHandler):
    def end_headers(self):
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_request(self, *_):
        pass


folder, port = sys.argv[1:]
try:
    server = http.server.ThreadingHTTPServer(("127.0.0.1", int(port)), functools.partial(Handler, directory=folder))
except (OSError, OverflowError, ValueError) as problem:
    sys.exit(f"cannot serve at port {port} (--port takes another): {problem}")
try:
    print(f"http://127.0.0.1:{server.server_port}/ (Ctrl+C ends)", flush=True)
    server.serve_forever()
except KeyboardInterrupt:
    pass
