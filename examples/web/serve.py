# SPDX-License-Identifier: MIT
# python3 serve.py FOLDER PORT: serves a folder to this machine alone. The two headers that isolate the page let it read
# clocks to 5 us, which are 100 us otherwise, and no file is kept that may have been built anew.
import functools
import http.server
import sys

HEADERS = {
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Embedder-Policy": "require-corp",
    "Cache-Control": "no-store",
}


class Handler(http.server.SimpleHTTPRequestHandler):
    def end_headers(self):
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def log_request(self, *_):
        pass


folder, port = sys.argv[1], int(sys.argv[2])
address = ("127.0.0.1", port)
try:
    server = http.server.ThreadingHTTPServer(address, functools.partial(Handler, directory=folder))
except OSError as problem:
    sys.exit(f"cannot serve at port {port}: {problem.strerror}; --port takes another")
try:
    print(f"http://127.0.0.1:{server.server_port}/ (Ctrl+C ends)", flush=True)
    server.serve_forever()
except KeyboardInterrupt:
    pass
