# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "BORDER"
op.amount = "COUNT"
op.per_side = 20
op.count = 400
op.density = 1000.0
op.distance = 0.05
op.border_jitter = 1.0
op.direction = "OUTWARDS"
op.lift = 0.5
op.flow = 0.9
op.length = 0.1
op.points = 6
op.tilt = (0.0, 0.0)
op.random = 0.3
op.random_length = 0.4
op.radius = 0.0015
