# SPDX-License-Identifier: GPL-3.0-or-later
import bpy

op = bpy.context.active_operator

op.distribution = "BLUE_NOISE"
op.amount = "DISTANCE"
op.per_side = 20
op.count = 1000
op.density = 1000.0
op.distance = 0.08
op.border_jitter = 0.0
op.direction = "NORMAL"
op.lift = 0.0
op.flow = 0.0
op.instances = "SCALE"
op.instance = ""
op.collection = ""
op.scale_length = 0.2
op.scale = 1.0
op.random_scale = 0.0
op.rotation = 0.0
op.random_rotation = 0.0
op.tilt = (0.0, 0.0)
op.random = 0.0
