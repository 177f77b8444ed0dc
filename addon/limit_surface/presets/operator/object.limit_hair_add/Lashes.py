# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "BORDER"
op.amount = "COUNT"
op.per_side = 20
op.count = 200
op.density = 1000.0
op.distance = 0.05
op.border_jitter = 0.4
op.direction = "OUTWARDS"
op.lift = 0.6
op.flow = 0.0
op.length = 0.15
op.points = 8
op.tilt = (0.0, 0.0)
op.random = 0.12
op.random_length = 0.25
op.radius = 0.002
