"""Makes the drawings in this folder with ezdxf 1.4: python make.py [FOLDER]

Prints the floor area of each by shapely and ezdxf's own geometry. tests/dxf.rs computes the areas by hand.
"""
import math
import sys
from pathlib import Path

import ezdxf
from ezdxf import disassemble, path
from shapely import set_precision
from shapely.geometry import LineString, Polygon
from shapely.ops import polygonize, unary_union

FOLDER = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parent)


def rectangle(x, y, width, height):
    return [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]


def office():
    """Walls as double lines in millimeters, without a unit in the header; doors as blocks with swings.

    Four rooms of 4 by 5 m, and a corridor of 16.6 by 2 m below them with an exit on the right."""
    doc = ezdxf.new("R12")
    msp = doc.modelspace()
    wall = {"layer": "A-WALL"}
    door = doc.blocks.new("DOOR")
    door.add_line((0, 0), (0, 1000), dxfattribs={"layer": "0"})
    door.add_arc((0, 0), 1000, 0, 90, dxfattribs={"layer": "0"})
    for k in range(4):
        x = 4200 * k
        # The room, with an opening of 1 m in its lower wall.
        points = [(x + 1500, 2200), (x, 2200), (x, 7200), (x + 4000, 7200), (x + 4000, 2200), (x + 2500, 2200)]
        msp.add_polyline2d(points, dxfattribs=wall)
        for side in (1500, 2500):
            msp.add_line((x + side, 2000), (x + side, 2200), dxfattribs=wall)
        msp.add_blockref("DOOR", (x + 1500, 2200), dxfattribs={"layer": "A-DOOR"})
        msp.add_text(f"Room {k + 1}", height=300, dxfattribs={"layer": "A-ANNO"}).set_placement((x + 500, 6000))
    # The corridor, in parts between the openings above.
    corners = [(16600, 0), (0, 0), (0, 2000), (1500, 2000)]
    msp.add_polyline2d(corners, dxfattribs=wall)
    for k in range(3):
        msp.add_line((4200 * k + 2500, 2000), (4200 * k + 5700, 2000), dxfattribs=wall)
    msp.add_line((4200 * 3 + 2500, 2000), (16600, 2000), dxfattribs=wall)
    msp.add_line((16600, 0), (16600, 2000), dxfattribs={"layer": "exits"})
    # The outside of the building.
    outside = [(16600, -300), (-300, -300), (-300, 7500), (16900, 7500), (16900, 2000), (16600, 2000)]
    msp.add_polyline2d(outside, dxfattribs=wall)
    msp.add_line((16600, 0), (16600, -300), dxfattribs=wall)
    msp.add_line((0, -900), (16600, -900), dxfattribs={"layer": "A-DIMS"})
    return doc


def arena():
    """A round hall 40 m wide in meters, 345 and 5,268 km from the origin, with an oval stage of bulges, eight columns
    in a circle (two of them mirrored by their extrusion direction) and a closed gap of 1 cm in its outline."""
    doc = ezdxf.new("R12")
    msp = doc.modelspace()
    x, y = 345020, 5268030
    bulge = math.tan(math.pi / 8)
    outline = [(x + 20, y, bulge), (x, y + 20, bulge), (x - 20, y, bulge), (x, y - 20, 0), (x + 20, y - 0.01, 0)]
    msp.add_polyline2d(outline, format="xyb", dxfattribs={"layer": "floor"})
    stage = [(x - 4, y - 2, 0), (x + 4, y - 2, 1), (x + 4, y + 2, 0), (x - 4, y + 2, 1)]
    msp.add_polyline2d(stage, format="xyb", close=True, dxfattribs={"layer": "barriers"})
    for k in range(8):
        angle = math.pi / 8 + k * math.pi / 4
        at = (x + 10 * math.cos(angle), y + 10 * math.sin(angle))
        if k in (2, 5):
            below = {"layer": "columns", "extrusion": (0, 0, -1)}
            msp.add_circle((-at[0], at[1]), 0.5, dxfattribs=below)
        else:
            msp.add_circle(at, 0.5, dxfattribs={"layer": "columns"})
    return doc


def station():
    """A hall of lines in blocks, with rows of columns in nested, mirrored and arrayed blocks, in centimeters."""
    doc = ezdxf.new("R12")
    msp = doc.modelspace()
    # A half of the outline as lines: 30 m by 8 m with a corner of 2 m by 2 m cut off.
    half = doc.blocks.new("HALF")
    corners = [(0, 0), (2800, 0), (3000, 200), (3000, 800)]
    for a, b in zip(corners, corners[1:]):
        half.add_line(b, a, dxfattribs={"layer": "0"})
    half.add_line((0, 0), (0, 800), dxfattribs={"layer": "0"})
    msp.add_blockref("HALF", (0, 0), dxfattribs={"layer": "floor"})
    msp.add_blockref("HALF", (0, 1600), dxfattribs={"layer": "floor", "yscale": -1})
    # A triangular column, and four of them around a point.
    column = doc.blocks.new("COLUMN", base_point=(10, 10))
    column.add_polyline2d([(10, 10), (70, 10), (10, 50)], close=True, dxfattribs={"layer": "0"})
    group = doc.blocks.new("GROUP")
    for scales in [(1, 1), (-1, 1), (1, -1), (-1, -1)]:
        at = (20 * scales[0], 20 * scales[1])
        group.add_blockref("COLUMN", at, dxfattribs={"layer": "0", "xscale": scales[0], "yscale": scales[1]})
    array = {"layer": "columns", "column_count": 3, "column_spacing": 800, "row_count": 2, "row_spacing": 600}
    msp.add_blockref("GROUP", (600, 500), dxfattribs={**array, "rotation": 0})
    msp.add_blockref("GROUP", (2600, 800), dxfattribs={"layer": "columns", "rotation": 30, "xscale": -1.5, "yscale": 1.5})
    msp.add_text("Platform 1", height=60, dxfattribs={"layer": "names"}).set_placement((200, 200))
    return doc


def theater():
    """Hatches, ellipses and splines, R2010."""
    doc = ezdxf.new("R2010", units=6)
    msp = doc.modelspace()
    hall = msp.add_hatch(dxfattribs={"layer": "floor"})
    hall.paths.add_polyline_path([(0, 0), (24, 0, 0.4), (24, 18), (0, 18, -0.2)], is_closed=True)
    hall.paths.add_polyline_path(rectangle(3, 3, 2, 2), is_closed=True, flags=16)
    low = [(8, 4, 0), (12, 2, 0), (13, 7, 0), (9, 8, 0), (8, 4, 0)]
    msp.add_open_spline(low, degree=3, dxfattribs={"layer": "furniture"})
    msp.add_ellipse((18, 9), (3, 1), 0.5, dxfattribs={"layer": "furniture"})
    oval = msp.add_hatch(dxfattribs={"layer": "furniture", "extrusion": (0, 0, -1)})
    oval.paths.add_edge_path().add_ellipse((-10, 13), (2, 0.5), 0.6, 0, 360)
    return doc


def floor(doc):
    """The area of the floor without obstacles by ezdxf and shapely; for plans whose floor is drawn as areas."""
    floors, obstacles, lines = [], [], []
    parts = ((one.dxf.layer, part) for one in doc.modelspace() for part in disassemble.recursive_decompose([one]))
    for layer, entity in parts:
        # Layer 0 in a block is the layer of the block.
        layer = layer if entity.dxf.layer == "0" else entity.dxf.layer
        kind = floors if layer == "floor" else obstacles
        if layer not in ("floor", "columns", "barriers", "furniture"):
            continue
        if entity.dxftype() == "HATCH":
            rings = [Polygon([(v.x, v.y) for v in p.flattening(1e-4)]) for p in path.from_hatch(entity)]
            rings.sort(key=lambda ring: -ring.area)
            kind.append(rings[0] - unary_union(rings[1:]))
            continue
        points = [(v.x, v.y) for v in path.make_path(entity).flattening(1e-4)]
        if math.dist(points[0], points[-1]) < 0.02 and len(points) > 3:
            kind.append(Polygon(points).buffer(0))
        else:
            lines.append(LineString(points))
    floors += polygonize(set_precision(unary_union(lines), 1e-6))
    return (unary_union(floors) - unary_union(obstacles)).area


for make, unit in [(office, None), (arena, 1.0), (station, 0.01), (theater, 1.0)]:
    doc = make()
    doc.saveas(FOLDER / f"{make.__name__}.dxf")
    if make in (arena, theater):
        # Binary files before and after version R13 differ.
        doc.saveas(FOLDER / f"{make.__name__}_binary.dxf", fmt="bin")
    if unit:
        print(make.__name__, round(floor(doc) * unit**2, 4), "m²")
