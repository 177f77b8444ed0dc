# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "BLUE_NOISE"
op.amount = "COUNT"
op.per_side = 20
op.count = 10000
op.density = 1000.0
op.distance = 0.05
op.length = 0.8
op.points = 16
op.tilt = (0.0, 0.0)
op.random = 0.2
op.radius = 0.0006
