#!/usr/bin/env bash
# CairoSVG 2.9.1 (PyPI; needs the library cairo; Linux x86-64, Python 3.11).
#
# Guess: `font-size="75%"` of a `tspan` is three quarters of the letters around it, as the standard says, or the attribute is not read.
# Seen: it is three quarters of the picture: a subscript covers the sheet. A size in em, or a number, is right.
# Output seen:
#   in percent 8 % of the sheet is dark, in em 0.5 %
# Fails where both are alike.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install CairoSVG==2.9.1
python/bin/python - <<'END'
import io, cairosvg
from PIL import Image
def dark(size):
    svg = ('<svg xmlns="http://www.w3.org/2000/svg" width="400" height="400" viewBox="0 0 400 400"><rect width="400" height="400" fill="#fff"/>'
           f'<text x="20" y="200" font-size="60" font-family="sans-serif">C<tspan font-size="{size}">4</tspan></text></svg>')
    pixels = Image.open(io.BytesIO(cairosvg.svg2png(svg.encode()))).convert("L").tobytes()
    return sum(pixel < 128 for pixel in pixels) / len(pixels)
percent, em = dark("75%"), dark("0.75em")
print(f"in percent {percent:.0%} of the sheet is dark, in em {em:.1%}".replace("%", " %"))
assert percent > 5 * em > 0
END
