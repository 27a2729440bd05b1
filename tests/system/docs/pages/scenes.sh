# Prepares for docs/scenes.md: a model with smooth normals, and an image sky.
python3 - <<'END'
from math import cos, pi, sin

columns, rows = 64, 16
with open("model.obj", "w", encoding="utf-8") as file:
    corners = [(2 * pi * i / columns, 2 * pi * j / rows) for i in range(columns) for j in range(rows)]
    for a, b in corners:
        file.write(f"v {(1 + 0.35 * cos(b)) * cos(a)} {0.35 * sin(b)} {(1 + 0.35 * cos(b)) * sin(a)}\n")
    for a, b in corners:
        file.write(f"vn {cos(b) * cos(a)} {sin(b)} {cos(b) * sin(a)}\n")
    for i in range(columns):
        for j in range(rows):
            quad = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)]
            at = [x % columns * rows + y % rows + 1 for x, y in quad]
            file.write("f " + " ".join(f"{k}//{k}" for k in at) + "\n")
END
python3 tests/system/sky_image.py sky.exr 64 '(9, 6, 4) if 0.8 * right + 0.6 * up > 0.97 else (0.4, 0.5, 0.7)'
