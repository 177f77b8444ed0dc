# SPDX-License-Identifier: GPL-3.0-or-later
"""Every name that scripts, files and menus rely on, each stated once."""

TAB = "Limit"

HAIR_ADD = "object.limit_hair_add"
POINTS_ADD = "object.limit_points_add"
SNAP = "object.limit_snap"
SNAP_MODAL = "view3d.limit_snap_modal"
DRAW = "view3d.limit_draw"
CURVE_LAY = "object.limit_curve_lay"
REPORT_OPERATOR = "object.limit_report"
SHOW = "object.limit_show"
BAKE_MAPS = "object.limit_bake_maps"
PROJECT_IMAGE = "object.limit_project_image"
CURVATURE = "object.limit_curvature"
BAKE_DISPLACEMENT = "object.limit_bake_displacement"
LIMIT_MESH = "object.limit_mesh"
FOLLOW = "object.limit_follow"
UNBIND = "object.limit_unbind"
REBIND = "object.limit_rebind"
ATTACH = "object.limit_attach"
CHILDREN_ADD = "object.limit_children_add"
PARTICLES_FROM_HAIR = "object.limit_particles_from_hair"
HAIR_FROM_PARTICLES = "object.limit_hair_from_particles"
SAMPLE_TABLES = "object.limit_sample_tables"
SAMPLE_REMOVE = "object.limit_sample_remove"
SAMPLE_ADD = "node.limit_sample_add"

COMMAND = "limit_surface"  # blender --command limit_surface

PANEL = "VIEW3D_PT_limit_surface"
REPORT_PANEL = "VIEW3D_PT_limit_report"
HAIR_PANEL = "VIEW3D_PT_limit_hair"
POINTS_PANEL = "VIEW3D_PT_limit_points"
DRAW_PANEL = "VIEW3D_PT_limit_draw"
HAIR_PRESETS = "VIEW3D_PT_limit_hair_presets"
POINTS_PRESETS = "VIEW3D_PT_limit_points_presets"
SNAP_PANEL = "VIEW3D_PT_limit_snap"
TEXTURES_PANEL = "VIEW3D_PT_limit_textures"
PARTICLES_PANEL = "VIEW3D_PT_limit_particles"
FOLLOW_PANEL = "VIEW3D_PT_limit_follow"
OBJECT_MENU = "VIEW3D_MT_object_limit_surface"

ATTRIBUTE_PREFIX = "limit_"

# Attributes of generated curves and points
FACE = "limit_face"
UV = "limit_uv"
REST_ROOT = "rest_root"
REST_ROTATION = "rest_rot"
SURFACE_UV = "surface_uv_coordinate"  # defined by Blender
NORMAL = "normal"
TANGENT = "tangent"
ROTATION = "rotation"
SCALE = "scale"
MEMBER = "instance_index"

# Attributes of the surface's mesh
DISTANCE = "limit_distance"
DISTANCE_COLOR = "limit_distance_color"

# Attributes of the data on which curvature is stored
CURVATURE_MEAN = "limit_curvature_mean"
CURVATURE_GAUSSIAN = "limit_curvature_gaussian"
CURVATURE_K1 = "limit_curvature_k1"
CURVATURE_K2 = "limit_curvature_k2"
CURVATURE_DIRECTION1 = "limit_curvature_direction1"
CURVATURE_DIRECTION2 = "limit_curvature_direction2"
CURVATURE_IRREGULAR = "limit_curvature_irregular"
CURVATURE_COLOR = "limit_curvature_color"

# Attributes of the surface's mesh that Blender defines
POSITION = "position"
CORNER_VERTEX = ".corner_vert"
CORNER_EDGE = ".corner_edge"
EDGE_VERTICES = ".edge_verts"
EDGE_SELECTION = ".select_edge"  # where it is missing, nothing is selected
FACE_SELECTION = ".select_poly"  # likewise
EDGE_CREASE = "crease_edge"
VERTEX_CREASE = "crease_vert"
CUSTOM_NORMAL = "custom_normal"
SHARP_EDGE = "sharp_edge"
SHARP_FACE = "sharp_face"

# Attributes of curves that Blender defines
CURVE_TYPE = "curve_type"
HANDLE_LEFT = "handle_left"
HANDLE_RIGHT = "handle_right"
SELECTION = ".selection"  # where it is missing, all is selected

REPORT = "limit_report"  # custom property of the surface's object

HAIR_OBJECT = "Limit Hair"
DRAWING_OBJECT = "Limit Drawing"
GUIDES_OBJECT = "Limit Guides"
POINTS_OBJECT = "Limit Points"
CURVATURE_OBJECT = "Limit Curvature"
LIMIT_MESH_OBJECT = "Limit Mesh"
DECAL_OBJECT = "Limit Decal"
DECAL_UV = "Image"  # UV map of decals
CHILDREN_OBJECT = "Limit Children"
INSTANCES_GROUP = "Limit Instances"
MEMBERS_GROUP = "Limit Collection Instances"
SCALES_GROUP = "Limit Scales"

# Custom properties of Curve objects' data, which have no attributes: FACE and UV, as above, of all
# control points in the order in which nodes number them, and the distance along the normal
OFFSET = "limit_offset"

# What follows a deforming surface: groups, the tables that they read, and their attributes
GROUP_MARK = "limit_surface_group"  # custom property of node groups: their name and version
SIGNATURE = "limit_surface_signature"  # custom property of the table of tiles, and of what follows
# custom property of what follows: the surface that it belonged to when it was bound
SURFACE_NAME = "limit_surface_name"
CAPTURE_GROUP = "Limit Capture"
TILES_GROUP = "Limit Tiles"
SAMPLE_TILE_GROUP = "Sample Limit Tile"
SAMPLE_GROUP = "Sample Limit Surface"
LOCATE_GROUP = "Locate Limit Tile"
FOLLOW_HAIR_GROUP = "Limit Hair"
FOLLOW_BEZIER_GROUP = "Limit Bezier Hair"
FOLLOW_POINTS_GROUP = "Limit Follow"
FOLLOW_ORIENTED_GROUP = "Limit Follow Oriented"
FOLLOW_NORMALS_GROUP = "Limit Follow Normals"
FOLLOW_CURVE_GROUP = "Limit Curve"
TUBE_GROUP = "Limit Tube"
FOLLOW_LIVE_GROUP = "Limit Live"
CHILDREN_GROUP = "Limit Children"
CHILDREN_TABLE = "Limit Children Table"
CHILDREN_SETTINGS = "limit_surface_children"  # custom properties of live children
CHILDREN_GUIDES = "limit_surface_guides"
POINTS_TABLE = "Limit Points"
TILES_TABLE = "Limit Tiles"
ALL_POINTS_TABLE = "Limit All Points"
ALL_TILES_TABLE = "Limit All Tiles"
FACES_TABLE = "Limit Faces"
ALL_TILES_MARK = "limit_surface_depth"  # custom property of tables of all tiles: their depth
FACES_MARK = "limit_surface_faces"  # custom property of meshes of a surface's faces: their levels
ASSET_LIBRARY = "Limit Surface"
CURVE_TABLE = "Limit Curve"
CARRIER = "Limit Carrier"
CARRIER_MARK = "limit_surface_carrier"  # custom property of carriers
CARRIED_BY = "limit_carrier"  # custom property of attached objects: their carrier
LINKED_SURFACE = "limit_linked_surface"  # custom property of what lies on a linked surface
PROXY_OBJECT = "Limit Proxy"
CAGE_POSITION = "cage_position"
CAGE_COUNT = "cage_count"
CAGE_TOPOLOGY = "cage_topology"
CAGE_EDGE_CREASES = "cage_edge_creases"
CAGE_VERTEX_CREASES = "cage_vertex_creases"
CAGE_FITS = "cage_fits"
TILE_MATRIX = "limit_matrix"
TILE = "limit_tile"  # the tile of a curve or point, counted from 1; 0 for what does not follow
TILE_UV = "tile_uv"
SEAL = "limit_seal"  # numbers of each vertex that tell it from averages of others

# What follows live: the property of scenes that switches it off, and attributes of the things
LIVE = "limit_live"
LIVE_REST = "limit_rest"  # the points at rest; with _ and a name: other attributes at rest
LIVE_FINGERPRINT = "limit_fingerprint"  # of the points as they were written
LIVE_SOURCE = "limit_source"  # custom property of the data: what the surface's faces came from
LIVE_WRITTEN = "limit_written"  # custom property of the data: the frame and the matrix of that

CAGE_SCENE = ".limit_cage"
BAKE_COLLECTION = ".limit_bake"
WEIGHTS_GROUP = ".limit_weights"
LINES_GROUP = ".limit_lines"
VERTEX_WEIGHT = ".limit_weight"  # attribute of the private scene's meshes

DISPLACEMENT = "limit_displacement"  # custom property of images that hold displacement
PIXELS_MARK = "limit_surface_pixels"  # custom property of images that operators have changed
TEMPORARY_IMAGE = ".limit_image"
TEMPORARY_HAIR = ".limit_hair"
TEMPORARY_MESH = ".limit_mesh"
