# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "UNIFORM"
op.amount = "COUNT"
op.per_side = 20
op.count = 20000
op.density = 1000.0
op.distance = 0.05
op.border_jitter = 0.0
op.direction = "NORMAL"
op.lift = 0.0
op.flow = 0.0
op.length = 0.15
op.points = 4
op.tilt = (0.0, 0.0)
op.random = 0.5
op.random_length = 0.6
op.radius = 0.003
