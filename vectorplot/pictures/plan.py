"""Which stages a scene calls for."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import projection_of
from vectorplot.pictures.pipeline import Stage
from vectorplot.scene.added_lines import shining
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import box_corners, field_of_vision
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import ball_of, capped_quadric_of, is_quadric_body
from vectorplot.tolerances import ZERO_OF_EXTENT
from vectorplot.words import FEATURE_KINDS, LIGHT_KINDS, LineKind

DEEP = 2.0
"""Where the farthest is so many times as far from the eye as the nearest, trapezoidal shadow maps have a tenth fewer
wrong pixels than whole ones, or much fewer; in shallower views they gain nothing (three dozen views, five lights)."""


def with_accuracy(stages: Sequence[Stage], said: Mapping[str, str]) -> tuple[Stage, ...]:
    """The stages; those that are named in what is said tell besides why they run how far off they may be, and which
    option changes that."""
    return tuple(
        replace(stage, why=f"{stage.why}; {said[stage.name]}") if stage.name in said else stage for stage in stages
    )


def accuracy_of_draw(tolerance_mm: float, smooth: bool) -> dict[str, str]:
    """What the stages of draw say of their accuracy. smooth: strokes of curves are drawn as such."""
    half = f"within {0.5 * tolerance_mm:g} mm"
    exact = f"exact: below {ZERO_OF_EXTENT:g} of the extent distances are zero"
    said = {"curves": f"chords {half} of them (--tolerance)", "visible lines": exact, "counted lines": exact}
    return said | ({"pen": f"curves {half} of their chords (--tolerance)"} if smooth else {})


def accuracy_of_paint(tolerance_mm: float) -> dict[str, str]:
    """What the stages of paint say of their accuracy."""
    zero = f"distances below {ZERO_OF_EXTENT:g} of the extent are zero"
    return {
        "facets": f"outlines asked for within {tolerance_mm:g} mm (--tolerance)",
        "order": zero,
        "shades": "(--tolerance, --palette)",
        "shadows": zero,
    }


def accuracy_of_render(facet_pixels: float, shadows: str, texels: int) -> dict[str, str]:
    """What the stages of render say of their accuracy: facet_pixels: how far triangles may be off smooth surfaces;
    shadows: the way they are found; texels: along a side of the maps."""
    said = {
        "facets": f"within {facet_pixels:g} of a sample (--size, --samples)",
        "depth": "decided in the middles of samples",
    }
    if shadows in ("buffer", "trapezoid", "perspective"):
        said["shadows"] = (
            f"borders off by about a texel of {texels} x {texels} (--shadow-size; --shadows exact has none)"
        )
    return said


def plan_cuts(scene: Scene, camera: Camera) -> tuple[Stage, ...]:
    """The stages before all others where a scene is cut, or the camera has a near or a far plane."""
    given = [f"{name} {depth:g}" for name, depth in (("near", camera.near), ("far", camera.far)) if depth is not None]
    number = len(scene.cuts)
    cuts = (Stage("cuts", f"the scene has {number} cut{'s' if number > 1 else ''}"),) if number else ()
    return (*cuts, *((Stage("near and far", f"the camera has {' and '.join(given)}"),) if given else ()))


def plan_draw(
    scene: Scene,
    kinds: frozenset[LineKind],
    hidden: str,
    halo_mm: float,
    style: str = "plain",
    reflections: int = 0,
    bends: bool = False,
) -> tuple[Stage, ...]:
    """The stages that drawing this scene calls for, in their order; nothing else runs. bends: whether glass does."""
    wanted = kinds.union(*(map(LineKind.from_word, item.lines) for item in scene.items if item.lines is not None))
    stages = [
        Stage("look", "the scene in the camera's axes, in the unit box"),
        Stage("faces", "the faces in the image, and which side they show"),
    ]
    of_edges = wanted - {LineKind.INTERSECTION, LineKind.PATTERN, LineKind.OUTLINE}
    if of_edges:
        stages.append(Stage("edges", ", ".join(sorted(kind.word for kind in of_edges))))
    if LineKind.INTERSECTION in wanted:
        stages.append(Stage("intersections", "items, or parts of an item, may pierce each other"))
    if LineKind.PATTERN in wanted and any(item.patterns for item in scene.items):
        stages.append(Stage("patterns", "faces carry patterns"))
    drawn_on_meshes = {LineKind.ISOPHOTE, LineKind.SECTION, LineKind.INDEX, LineKind.INTEGRAL}
    features = wanted & set(FEATURE_KINDS) and any(isinstance(item.shape, Mesh) for item in scene.items)
    across = LineKind.CONTOUR in wanted and any(
        isinstance(item.shape, Mesh) and item.curves.smooth_contours for item in scene.items
    )
    if features or across or (wanted & drawn_on_meshes and any(map(_has_mesh_lines, scene.items))):
        stages.append(
            Stage(
                "lines on meshes",
                "polyhedra carry isophotes, sections, integral curves, contours, lines of terrains or of curvature",
            )
        )
    smooth = [item.shape for item in scene.items if not isinstance(item.shape, Mesh)]
    lit = wanted & set(LIGHT_KINDS)
    # What light ends on is looked for on surfaces with parameters.
    balls = not lit and any(ball_of(shape) or capped_quadric_of(shape) for shape in smooth)
    if balls:
        stages.append(Stage("balls", "spheres, ellipsoids and capped bodies, and the conics on them"))
    if lit:
        stages.append(_light_stage(scene, lit))
    if smooth:
        stages.append(Stage("curves", "items are smooth surfaces"))
        if style == "plain":
            stages.append(Stage("smooth surfaces", "they hide curves and lines"))
    stages.append(Stage("frame", "what is in front of the eye and inside the picture"))
    if balls and style == "plain":
        stages.append(Stage("behind balls", "spheres, ellipsoids and capped bodies hide lines"))
    if style != "plain":
        stages.append(Stage("all lines", f"nothing hides anything in the style {style}"))
    elif hidden == "none":
        stages.append(Stage("visible lines", "hidden lines are left out"))
    else:
        stages.append(Stage("counted lines", f"hidden lines are drawn {hidden}"))
    if reflections and style == "plain" and wanted - {LineKind.OUTLINE} and _has_mirrors(scene):
        why = f"items are mirrors: lines that one sees in them{_deep(reflections)}"
        stages.append(Stage("reflected lines", why))
    if bends and style == "plain" and wanted - {LineKind.OUTLINE} and refracts(scene):
        stages.append(Stage("refracted lines", "items refract light: lines in them and behind them"))
    if halo_mm > 0.0:
        stages.append(Stage("halo", f"lines end {halo_mm:g} mm beside what is in front of them"))
    stages.append(Stage("strokes", "lines on the page, those that lie on each other once"))
    stages += _label_stages(scene)
    if LineKind.OUTLINE in wanted:
        stages.append(Stage("outline", "closed paths around what things cover of the page together"))
    stages.append(Stage("layers", "what shares a pen"))
    if style == "plain":
        stages += _cue_stages(scene)
    stages.append(Stage("pen", "strokes joined, in an order that keeps the pen on the paper"))
    return tuple(stages)


def _light_stage(scene: Scene, kinds: Collection[LineKind]) -> Stage:
    """The stage that finds lines between light and dark of these kinds."""
    lamps = len(shining(scene.lights)) if scene.lights else 1
    words = " and ".join(
        {"terminator": "terminators", "shadow": "edges of shadows"}[kind.word] for kind in sorted(kinds)
    )
    return Stage("light and dark", f"{words} of {lamps} light{'s' if lamps != 1 else ''}")


def plan_arcs(stages: Sequence[Stage]) -> tuple[Stage, ...]:
    """The stages of draw, and last the one that takes polygons for the arcs that they stand for."""
    return (*stages, Stage("arcs", "polygons that stand for circles and ellipses leave as arcs of these"))


def plan_panorama() -> tuple[Stage, ...]:
    """The stages of a panorama."""
    return (
        Stage("panorama", "the visible lines of every quarter of the round, unrolled"),
        Stage("layers", "what shares a pen"),
        Stage("pen", "strokes joined, in an order that keeps the pen on the paper"),
    )


def _cue_stages(scene: Scene) -> list[Stage]:
    """The stage that divides lines by their depth, where the scene says so."""
    cue = scene.depth_cue
    return [] if cue is None else [Stage("depth cue", f"{' and '.join(cue.by)} of lines by depth, {cue.steps} steps")]


def _label_stages(scene: Scene) -> list[Stage]:
    """The stage that letters places and level lines, where the scene has names or numbers for any."""
    numbered = any(section.numbered for item in scene.items for section in item.curves.sections)
    why = "places have names" if scene.labels else "level lines have numbers"
    return [Stage("labels", f"{why}; lines end before the letters")] if scene.labels or numbered else []


def plan_hatching(scene: Scene, given: Hatching | Stippling | None, stages: Sequence[Stage]) -> tuple[Stage, ...]:
    """The stages of draw, with the one that hatches faces before layers where anything is hatched. given: how items are
    hatched that do not say it themselves."""
    how = dict.fromkeys(given if item.hatch is None else item.hatch for item in scene.items)
    words = dict.fromkeys(one.by for one in how if one is not None and one.by != "none")
    if not words:
        return tuple(stages)
    hatching = Stage("hatching", f"faces are hatched by {', '.join(words)}")
    at = [stage.name for stage in stages].index("layers")
    return (*stages[:at], hatching, *stages[at:])


def chosen_shadows(scene: Scene, camera: Camera, size: tuple[int, int], fit: bool) -> tuple[str, str]:
    """Which shadows this view of a scene calls for, none, buffer or trapezoid, and why.

    size: columns and rows of the picture; fit: whether all of the scene is to fill it. Decided by the box about the
    scene. Errors: InputError, with the item's name, for a surface without a finite point.
    """
    if not any(light.intensity != 0.0 for light in scene.lights):
        return "none", "no light shines"
    solid = any(item.material.opacity >= 1.0 for item in scene.items)
    if not any(item.casts_shadow or (solid and item.dims_light) for item in scene.items):
        return "none", "nothing stops light"
    projection = projection_of(camera, scene.bounds)
    corners = projection.points_of(box_corners(scene.bounds))
    if projection.eye is not None:
        depth = projection.depth_of(corners)
        near, far = float(depth.min()), float(depth.max())
        if not near > 0.0:
            return "trapezoid", "the eye is amid the scene"
        if far >= DEEP * near:
            return "trapezoid", f"what is farthest is {far / near:.1f} times as far away as what is nearest"
    low, high = field_of_vision(projection, Page(*size, 0.0), fit).window
    image = projection.image_of(corners).T
    if not fit and ((image < low) | (image > high)).any():
        return "trapezoid", "the picture shows a part of the scene"
    return "buffer", "everything is about as far away"


def plan_render(scene: Scene, shadows: str, lines: bool, why: str = "", reflections: int = 1) -> tuple[Stage, ...]:
    """The stages that rendering this scene calls for, in their order; nothing else runs. why: of such shadows."""
    stages = []
    if has_surfaces(scene):
        stages.append(Stage("facets", "smooth surfaces become triangles smaller than pixels can show"))
    stages.append(Stage("look", "the scene in the camera's axes, in the unit box"))
    stages.append(Stage("triangles", "all faces, with the normals at their corners"))
    if shadows != "none" and scene.lights:
        how = {
            "buffer": "shadow buffers",
            "trapezoid": "trapezoidal shadow maps",
            "perspective": "perspective shadow maps",
            "exact": "exactly",
        }[shadows]
        stages.append(Stage("shadows", f"{len(scene.lights)} lights cast them: {how}" + (why and f", as {why}")))
        if any(item.dims_light for item in scene.items):
            stages.append(Stage("transparent shadows", "items are transparent"))
    stages.append(Stage("coplanar", "which of the faces in one plane is seen"))
    stages.append(Stage("depth", "which triangle or quadric body is in front in every pixel"))
    stages.append(Stage("shading", "every visible point once"))
    if reflections and any(item.material.is_mirror for item in scene.items):
        stages.append(Stage("mirrors", f"what mirrors show{_deep(reflections)}"))
    if any(item.material.opacity < 1.0 for item in scene.items):
        stages.append(Stage("transparency", "what one sees through"))
    if lines or any(map(is_annotation, scene.items)):
        stages.append(Stage("lines", "drawn over the picture, with exact hidden lines"))
        stages += _cue_stages(scene)
    stages += _label_stages(scene)
    stages.append(Stage("average", "the pixels of the picture"))
    return tuple(stages)


def _has_mesh_lines(item: Item) -> bool:
    """Whether an item is a polyhedron with lines of a smooth one."""
    curves = item.curves
    return isinstance(item.shape, Mesh) and bool(
        curves.isophotes or curves.sections or curves.integral or curves.terrain or curves.contours
    )


def _shading_stages(scene: Scene, shadows: str, reflections: int) -> list[Stage]:
    """The stages that give colours to painted faces, and what is painted between them."""
    stages = []
    stages.append(
        Stage("shades", f"{len(scene.lights)} lights" if scene.lights else "no light: one from the eye's left")
    )
    casts = shadows == "auto" and bool(scene.lights)
    clear = any(item.material.opacity < 1.0 for item in scene.items)
    if casts:
        stages.append(Stage("shadows", f"{len(scene.lights)} lights cast them"))
    mirrors = has_plane_mirrors(scene)
    if casts and mirrors:
        stages.append(Stage("mirror light", "mirrors throw light back"))
    if any(item.patterns for item in scene.items):
        stages.append(Stage("patterns", "faces carry patterns"))
    if casts and clear:
        stages.append(Stage("transparent shadows", "items are transparent"))
    if reflections and mirrors:
        stages.append(Stage("reflections", f"items are mirrors{_deep(reflections)}"))
    if clear and any(item.material.refraction != 1.0 for item in scene.items):
        stages.append(Stage("refraction", "items refract light"))
    stages.append(Stage("fills", "polygons on the page"))
    return stages


def plan_paint(
    scene: Scene, shadows: str, fills: str, kinds: frozenset[LineKind], reflections: int = 1
) -> tuple[Stage, ...]:
    """The stages that painting this scene calls for, in their order; nothing else runs."""
    stages = []
    if has_surfaces(scene):
        stages.append(Stage("facets", "smooth surfaces become triangles within the tolerance"))
    stages.append(Stage("look", "the scene in the camera's axes, in the unit box"))
    stages.append(Stage("faces", "the faces in the image, and which side they show"))
    stages.append(Stage("order", "back to front; what pierces or overlaps cyclically is cut"))
    # Mirrors and refracting glass show what nothing else does.
    shows_more = any(item.material.is_mirror or item.material.refraction != 1.0 for item in scene.items)
    of_surfaces = any(not isinstance(item.shape, Mesh) or item.normals is not None for item in scene.items)
    if of_surfaces and not shows_more:
        stages.append(Stage("unseen facets", "triangles of smooth surfaces that are wholly covered are left out"))
    if fills != "erasing" and any(item.material.opacity < 1.0 for item in scene.items):
        stages.append(Stage("transparent sheets", "polygons of transparent items stand together where they can"))
    if fills == "erasing":
        stages.append(Stage("outlines", "the visible lines of the scene"))
        stages.append(Stage("erasing", "faces in the colour of the paper, and the lines on them"))
    else:
        stages += _shading_stages(scene, shadows, reflections)
    if fills == "visible":
        stages.append(Stage("visible fills", "each without what is painted over it"))
        if any(item.material.opacity < 1.0 for item in scene.items):
            stages.append(Stage("screen door", "transparent polygons become sparse lines"))
    shown = sorted(kind.word for kind in kinds) if fills != "erasing" else []
    shown += ["axes, dimensions and centre lines"] if any(map(is_annotation, scene.items)) else []
    if shown:
        stages.append(Stage("lines", ", ".join(shown) + " on top"))
        stages += _cue_stages(scene)
    stages += _label_stages(scene)
    return tuple(stages)


def _deep(reflections: int) -> str:
    """How deep mirrors in mirrors are followed, as far as there are any."""
    return f", and mirrors in them, {reflections} deep" if reflections > 1 else ""


def has_plane_mirrors(scene: Scene) -> bool:
    """Whether there are meshes, or faces of such, in which one sees other things."""
    return any(item.material.is_mirror and isinstance(item.shape, Mesh) for item in scene.items)


def _has_mirrors(scene: Scene) -> bool:
    """Whether there are things, or faces of such, in which one sees other things."""
    return any(item.material.is_mirror for item in scene.items)


def refracts(scene: Scene) -> bool:
    """Whether there are transparent polyhedra that bend light."""
    return any(
        item.material.refraction != 1.0 and not item.hides and isinstance(item.shape, Mesh) for item in scene.items
    )


def has_surfaces(scene: Scene) -> bool:
    """Whether there are shapes in a scene that are no meshes."""
    return any(not isinstance(item.shape, Mesh) for item in scene.items)


def is_whole(item: Item) -> bool:
    """Whether an item is a body that bands of shade can show: opaque, of one colour and whole."""
    plain = item.material.opacity >= 1.0 and item.material.refraction == 1.0 and item.hides
    plain &= not (item.patterns or item.cut_by or item.is_cut_face or item.group or item.curves.slices)
    return plain and item.fields is None and item.face_looks is None and is_quadric_body(item.shape)


def has_bodies(scene: Scene) -> bool:
    """Whether bands of shade can show some bodies of a scene, in white light that does not fade, and all else is
    opaque, no mirror, and of no group."""
    if not _has_plain_light(scene):
        return False
    drawn = [item for item in scene.items if not is_annotation(item)]
    whole = [is_whole(item) for item in drawn]
    return any(whole) and all(own or _is_plain(item) for item, own in zip(drawn, whole, strict=True))


def has_banded_surfaces(scene: Scene) -> bool:
    """Whether bands of shade can show some smooth surfaces of a scene, as has_bodies."""
    drawn = [item for item in scene.items if not is_annotation(item)]
    smooth = any(not isinstance(item.shape, Mesh) and may_have_bands(item) for item in drawn)
    return smooth and _has_plain_light(scene) and all(map(_is_plain, drawn))


def may_have_bands(item: Item) -> bool:
    """Whether bands of shade can show an item, if it is smooth: it has one colour everywhere."""
    return not item.patterns and item.fields is None and item.face_looks is None


def _has_plain_light(scene: Scene) -> bool:
    white = all(light.colour == "white" and not light.fading for light in scene.lights)
    return white and scene.exposure != "fitted"


def _is_plain(item: Item) -> bool:
    plain = item.material.opacity >= 1.0 and item.material.refraction == 1.0 and item.hides
    mirrors = item.material.is_mirror and isinstance(item.shape, Mesh)
    return plain and not (mirrors or item.group or item.curves.slices)


def plan_surface_bands(stages: Sequence[Stage]) -> tuple[Stage, ...]:
    """The stages of painting, with those of smooth surfaces in bands before the one of all other polygons."""
    at = [stage.name for stage in stages].index("shades")
    layers = Stage("layers", "what covers nothing else in its layer may come in any order")
    bands = Stage("surface bands", "smooth surfaces, layer by layer, in bands of equal shade (--tolerance)")
    return (*stages[:at], layers, *stages[at:], bands)


def plan_bodies(stages: Sequence[Stage]) -> tuple[Stage, ...]:
    """The stages of painting, before them those of bodies that are painted as wholes where that can be."""
    return (
        Stage("bodies", "balls, rods and other quadric bodies: back to front as wholes"),
        Stage("bands", "their visible parts in bands of equal shade (--tolerance)"),
        *stages,
    )
