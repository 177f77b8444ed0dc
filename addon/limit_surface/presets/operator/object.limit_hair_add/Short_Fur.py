# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "BLUE_NOISE"
op.amount = "COUNT"
op.per_side = 20
op.count = 20000
op.density = 1000.0
op.distance = 0.05
op.border_jitter = 0.0
op.direction = "NORMAL"
op.lift = 0.0
op.flow = 0.0
op.length = 0.07
op.points = 4
op.tilt = (0.0, 0.0)
op.random = 0.45
op.random_length = 0.3
op.radius = 0.0008
