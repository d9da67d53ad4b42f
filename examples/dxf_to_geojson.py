"""A floor plan from a DXF drawing, as GeoJSON: python examples/dxf_to_geojson.py plan.dxf plan.geojson

It needs ezdxf. The drawing needs closed polylines on two layers: FLOOR around what people walk on, WALLS around what they
do not.
"""

import json
import sys

import ezdxf

METERS = 0.001  # of one unit of the drawing: here millimeters
KINDS = {"FLOOR": "floor", "WALLS": "obstacle"}

drawing, plan = sys.argv[1:]
features = []
for line in ezdxf.readfile(drawing).modelspace().query("LWPOLYLINE"):
    if line.dxf.layer in KINDS and line.closed:
        ring = [[x * METERS, y * METERS] for x, y in line.get_points("xy")]
        geometry = {"type": "Polygon", "coordinates": [ring + ring[:1]]}
        features.append({"type": "Feature", "properties": {"kind": KINDS[line.dxf.layer]}, "geometry": geometry})
with open(plan, "w") as file:
    json.dump({"type": "FeatureCollection", "features": features}, file)
