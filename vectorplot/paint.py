"""The verb paint: a scene becomes filled polygons on a page, painted back to front."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.draw import default_camera, lines_in_place, seen_part, with_smooth_surfaces
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.layers import layers_by_kind
from vectorplot.drawing.painted_fills import Overlay, fills_on_page, placement_of_faces, shown_faces, stacked
from vectorplot.drawing.strokes.finishing import inked
from vectorplot.errors import InputError
from vectorplot.features.facets import Within
from vectorplot.geometry.budget import Budget, budget_of
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.unit_projection import projection_of
from vectorplot.plan import StageReport, Walk, plan_cuts, plan_paint
from vectorplot.scene.placement import Placement, allowed_in_space
from vectorplot.scene.scene import Light, Page, Scene
from vectorplot.scene.seams import without_seams
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.twins import without_twins
from vectorplot.scene.unbounded import tell_what_is_cut_off
from vectorplot.scene.view import View, view_of
from vectorplot.shading.light.face_shades import Shades, item_colours, view_lights
from vectorplot.shading.light.faceted import FacetedScene, faceted
from vectorplot.shading.light.fineness import picture_fineness
from vectorplot.shading.light.flat_regions import plane_numbers
from vectorplot.shading.light.painted_colours import Lighting, colours_of, corner_shades_of, opacities
from vectorplot.shading.light.painted_normals import painted_normals
from vectorplot.shading.light.palettes import PALETTE_SIZE, shaded_colours
from vectorplot.shading.light.palettes import palette as shades_of
from vectorplot.shading.light.refinement import SHORTEST_MM, refined
from vectorplot.visibility.painter.gathering import side_by_side
from vectorplot.visibility.painter.height_fields import known_orders
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.painter.order import Painted, painters_order
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import LINE_WORDS, LineKind, check_word, line_kinds

if TYPE_CHECKING:
    from vectorplot.effects.decals.decal_polygons import Decals

MOST_NAMES = 5
"""So many items of a knot are named."""

PEN = Pen()
"""What draws lines among fills."""

PAPER = "white"
"""The colour of the paper where the scene names none."""


def paint(
    scene: Scene,
    camera: Camera | None = None,
    *,
    page: Page | None = None,
    fit: bool = True,
    lights: Sequence[Light] | None = None,
    shadows: Literal["auto", "none"] = "auto",
    aura_mm: float = 0.0,
    palette: int = PALETTE_SIZE,
    smooth: bool = True,
    fills: Literal["painted", "visible", "erasing"] = "painted",
    lines: str | Iterable[str] = (),
    crease_angle_deg: float = 25.0,
    tolerance_mm: float = 0.02,
    budget: float = 1.0,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The scene as filled polygons on a page, each painted over those behind it.

    Parameters
    ----------
    scene : Scene
        What is painted.
    camera : Camera, optional
        That of the scene where None, else default_camera.
    page : Page, optional
        That of the scene where None, else A4.
    fit : bool
        The picture fills the page but for its margin; otherwise the page centre is the target and the page height the
        camera's picture height.
    lights : sequence of Light, optional
        In place of those of the scene.
    shadows : {"auto", "none"}
        Whether lights cast any.
    aura_mm : float
        The width of their soft borders in mm.
    palette : int
        How many shades every colour has; 2 to 256.
    smooth : bool
        Smooth surfaces, meshes that look round and planes on which the light varies are shaded from corner to corner;
        otherwise every plane has one shade.
    fills : {"painted", "visible", "erasing"}
        Polygons painted one over the other, or only what is seen of each, for pens, which cannot paint over things,
        with transparent ones as sparse lines; or blank, with the visible lines on them: hidden lines by erasing.
    lines : str or iterable of str
        Words of LineKind, or one text with commas between them, drawn on top with exact hidden lines, or on blank
        polygons (none: all kinds).
    crease_angle_deg : float
        Sharper edges are creases, and meshes look round where faces meet at less; 0 to 180 degrees.
    tolerance_mm : float
        How many mm the sides of polygons may be off smooth surfaces and refracted lines.
    budget : float
        As of draw, for lines and triangles.
    progress : callable, optional
        progress(stage, fraction) is called while it works.
    explain : callable, optional
        explain(report) is called while it works, with a StageReport.

    Returns
    -------
    Drawing
        The page in mm: a layer of fills, and where lines are asked for those of the lines on top.

    Raises
    ------
    InputError
        For unknown words and colours, impossible cameras, and widths and counts out of range; for a tolerance or a
        budget that is not finite and positive.

    Notes
    -----
    Degenerate: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees off
    the principal ray, a fitted picture shows the camera's field of vision. A scene without lights is lit from the eye's
    upper left, which casts no shadows.

    Source: Glaeser, chapters 4.5, 5 and 6.

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> tetrahedron = vp.Mesh.from_triangles(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    >>> scene = vp.Scene((vp.Item("tetrahedron", tetrahedron, "blue"),))
    >>> drawing = vp.paint(scene, lights=[vp.Light((3, -1, 4))], lines="contour")
    >>> [layer.name for layer in drawing.layers]
    ['fills', 'visible', 'contour']
    """
    _check_options(shadows, aura_mm, palette, fills, crease_angle_deg, tolerance_mm)
    budget_of(budget)
    scene = without_seams(scene if lights is None else replace(scene, lights=tuple(lights)))
    tell_what_is_cut_off(scene)
    camera = camera or scene.camera or default_camera(scene)
    page = page or scene.page or Page()
    kinds = line_kinds(lines)
    walk = Walk((*plan_cuts(camera), *plan_paint(scene, shadows, fills, kinds)), explain, progress)
    scene = seen_part(walk, scene, camera)
    projection = projection_of(camera, scene.bounds)
    # Lines belong to each item, polygons to what is seen.
    shown = scene if kinds or fills == "erasing" else without_twins(scene)
    facets = FacetedScene(shown, (None,) * len(shown.items))
    if walk.calls_for("facets"):
        allowed = allowed_in_space(scene, projection, page, fit, tolerance_mm)
        # Where each triangle has one shade they have to be so small that nobody sees it.
        shaded = smooth and fills == "painted"
        casts = shadows != "none" and bool(scene.lights)
        demand = picture_fineness(shown, projection, casts, allowed) if shaded else lambda number: Within(allowed)
        facets = walk.run("facets", faceted, shown, demand, budget_of(budget))
    facets = replace(facets, scene=_with_clear_items(facets.scene))
    view = walk.run("look", view_of, facets.scene, projection)
    projected = walk.run("faces", project_faces, view)
    known, groups = known_orders(shown, view), _groups(scene)
    sliced = {number: planes for number, item in enumerate(scene.items) if (planes := item.curves.slices)}
    painted = walk.run("order", painters_order, view, projected, known=known, sliced=sliced, group=groups)
    _tell_slices(walk, scene, sliced, painted)
    _tell_knots(walk, scene, painted)
    _tell_groups(walk, scene, painted)
    faces = painted.faces
    if walk.calls_for("transparent sheets"):
        from vectorplot.visibility.painter.gathering import gathered

        item = view.face_item[faces.source]
        sheet = np.where(opacities(facets.scene.items)[item] < 1.0, item, -1)
        faces = faces.some(walk.run("transparent sheets", gathered, faces, sheet, view.tolerance))
    plane = plane_numbers(view)
    faces = faces.some(side_by_side(faces, _planes_of(facets.scene, view, faces, plane), view.tolerance))
    placement = placement_of_faces(view, faces, page, fit)
    seen = _Seen(facets.scene, view, projected, shown_faces(faces, placement), placement)
    world = placement.page_from_world
    here = view_lights(view, scene.lights)
    normals = np.full((3, len(view.corners)), np.nan)
    if smooth and fills == "painted":
        normals = painted_normals(view, scene.items, here, facets.normals, plane, crease_angle_deg)
    elif smooth and fills == "visible":
        # Pens have no gradients: meshes and planes keep one shade for each of their faces.
        normals = painted_normals(view, scene.items, (), facets.normals, plane, 0.0)
    lighting = Lighting(scene.items, here, normals, plane, palette)
    ruler = _Ruler(scene, seen, crease_angle_deg, tolerance_mm, budget)
    if walk.calls_for("erasing"):
        polygons = _erased(walk, seen, scene, ruler, kinds or line_kinds(LINE_WORDS), palette)
    else:
        polygons = _shaded(walk, seen, lighting, page, aura_mm, tolerance_mm, budget_of(budget))
    if walk.calls_for("visible fills"):
        from vectorplot.drawing.fills_without_overlaps import visible_fills

        polygons = walk.run("visible fills", visible_fills, polygons, world)
    if walk.calls_for("screen door"):
        from vectorplot.effects.windows.screened_fills import screened

        polygons = walk.run("screen door", screened, polygons, PEN.width_mm, world)
    layers = [Layer("fills", PEN, (polygons,))]
    if walk.calls_for("lines"):
        layers += walk.run("lines", ruler.layers, kinds, walk.fraction("lines"))
    return Drawing(page.width_mm, page.height_mm, tuple(layers), tuple(i.name for i in scene.items), scene.title, world)


@dataclass(frozen=True, eq=False)
class _Seen:
    """What is painted: a scene without smooth surfaces, its view, its faces in the image, the polygons of the picture
    back to front, and where the picture goes."""

    scene: Scene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces
    placement: Placement


@dataclass(frozen=True, eq=False)
class _Ruler:
    """How the lines of a scene come to be on a picture of it, where its polygons have their place."""

    scene: Scene
    seen: _Seen
    crease_angle_deg: float
    tolerance_mm: float
    budget: float

    def layers(self, kinds: frozenset[LineKind], progress: Callable[[float], None]) -> tuple[Layer, ...]:
        """The visible lines in layers by kind."""
        found = self._found(self.scene, kinds, progress)
        return inked(layers_by_kind(found), "none", self.seen.placement.page_from_world, self.tolerance_mm)

    def strokes(self, scene: Scene, kinds: frozenset[LineKind]) -> Paths:
        """The visible lines as polylines. scene: this one, whatever patterns it has."""
        found = self._found(scene, kinds, None)
        (layer,) = inked((Layer("", PEN, (found,)),), "none", self.seen.placement.page_from_world)
        return layer.strokes[0]

    def _found(self, scene: Scene, kinds: frozenset[LineKind], progress: Callable[[float], None] | None) -> Paths:
        return lines_in_place(
            scene,
            *self._view,
            self.seen.placement,
            kinds,
            crease_angle_deg=self.crease_angle_deg,
            tolerance_mm=self.tolerance_mm,
            budget=self.budget,
            progress=progress,
        )

    @cached_property
    def _view(self) -> tuple[View, ProjectedFaces]:
        return with_smooth_surfaces(self.scene, self.seen.view, self.seen.projected)


def _with_clear_items(scene: Scene) -> Scene:
    """The scene in which light goes through whatever one can see through."""
    clear = [item.material.is_clear for item in scene.items]
    if not any(see and item.hides for see, item in zip(clear, scene.items, strict=True)):
        return scene
    items = (replace(item, occludes=item.hides and not see) for see, item in zip(clear, scene.items, strict=True))
    return replace(scene, items=tuple(items))


def _planes_of(scene: Scene, view: View, faces: ImageFaces, plane: Ints) -> Ints:
    """(n,) the planes of painted polygons, -1 for those of transparent items, which stand together as sheets."""
    clear = opacities(scene.items)[view.face_item[faces.source]] < 1.0
    return np.where(clear, -1, plane[faces.source])


def _groups(scene: Scene) -> Ints | None:
    """(i,) the number of each item's group, -1 for none; None where there are no groups."""
    names = sorted({item.group for item in scene.items} - {""})
    number = {"": -1, **{name: k for k, name in enumerate(names)}}
    return np.array([number[item.group] for item in scene.items], dtype=np.intp) if names else None


def _tell_groups(walk: Walk, scene: Scene, painted: Painted) -> None:
    """Tell the listener which groups stay together, and which do not."""
    names = sorted({item.group for item in scene.items} - {""})
    undone = [names[k] for k in painted.undone]
    if kept := [name for name in names if name not in undone]:
        walk.tell("groups", f"{', '.join(kept)}: ordered as wholes, then within", len(kept))
    if undone:
        walk.tell("groups undone", f"{', '.join(undone)}: something else comes between", len(undone))


def _tell_slices(walk: Walk, scene: Scene, sliced: Mapping[int, Section], painted: Painted) -> None:
    """Tell the listener which items are painted slice by slice, and which are not."""
    for number, planes in sliced.items():
        name = scene.items[number].name
        if number in painted.ribbons:
            count = painted.ribbons[number]
            walk.tell("ribbons", f"{name}: in {len(planes.offsets) + 1} slices, ribbon by ribbon", count)
        else:
            walk.tell("ribbons undone", f"{name}: something else is in front of it or behind it", 0)


def _tell_knots(walk: Walk, scene: Scene, painted: Painted) -> None:
    """Say which items were cut because no order of whole faces was right."""
    if len(painted) > painted.uncut:
        names = ", ".join(scene.items[number].name for number in painted.knots[:MOST_NAMES].tolist())
        more = f" and {len(painted.knots) - MOST_NAMES} more" if len(painted.knots) > MOST_NAMES else ""
        walk.tell("cut", f"{names}{more}: they pierce one another, or overlap in circles", len(painted) - painted.uncut)


def _check_options(
    shadows: str, aura_mm: float, palette: int, fills: str, crease_angle_deg: float, tolerance_mm: float
) -> None:
    check_word("shadows", shadows, ("auto", "none"))
    check_word("fills", fills, ("painted", "visible", "erasing"))
    if not 0.0 <= aura_mm < np.inf:
        raise InputError(f"an aura of {aura_mm:g} mm: expected a width that is finite and not negative")
    if not (2 <= palette <= 256 and float(palette).is_integer()):
        raise InputError(f"a palette of {palette} shades: expected 2 to 256")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    if not 0.0 < tolerance_mm < np.inf:
        raise InputError(f"a tolerance of {tolerance_mm:g} mm: expected a length that is finite and positive")


def _finer(seen: _Seen, lighting: Lighting, most: int) -> ImageFaces:
    """The polygons, those that are shaded so small that no corner shows, or as many as may be."""
    faces = seen.faces
    shortest = SHORTEST_MM / seen.placement.scale
    points, offsets, parent = refined(seen.view, lighting, faces.points, faces.offsets, faces.source, shortest, most)
    if len(parent) == len(faces):
        return faces
    return ImageFaces(points, offsets, faces.planes[:, parent], faces.source[parent], faces.rank[parent])


def _shades(seen: _Seen, lighting: Lighting) -> Shades:
    faces = seen.faces
    points = view_points(seen.view, faces.points)
    return corner_shades_of(seen.view, lighting, points, faces.offsets, faces.source)


def _erased(walk: Walk, seen: _Seen, scene: Scene, ruler: _Ruler, kinds: frozenset[LineKind], size: int) -> Fills:
    """Blank polygons, and the lines of the scene on them."""
    from vectorplot.drawing.erasing_fills import erased_fills, line_fills

    view, faces = seen.view, seen.faces
    blank = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=np.repeat(_paper(scene), faces.points.shape[1], axis=0),
        opacity=np.ones(len(faces)),
        item=view.face_item[faces.source],
        kind=np.full(len(faces), int(FillKind.BACKGROUND)),
    )
    drawn = walk.run("outlines", _coloured_strokes, scene, ruler, kinds, size)
    lines = Fills.joined(*(line_fills(strokes, ink) for strokes, ink in drawn))
    return walk.run("erasing", erased_fills, blank, lines, PEN.width_mm)


def _coloured_strokes(
    scene: Scene, ruler: _Ruler, kinds: frozenset[LineKind], size: int
) -> list[tuple[Paths, Colours]]:
    """The visible lines of a scene, and their inks (m,3): the middle shades of the palettes of items, and of those of
    patterns."""
    from vectorplot.drawing.strokes.paths import chosen
    from vectorplot.shading.light.depth_cueing import MIDDLE

    strokes = ruler.strokes(scene, kinds)
    plain = chosen(strokes, strokes.kind != LineKind.PATTERN)
    found = [(plain, item_colours(scene.items, plain.item, np.full(len(plain), MIDDLE), size))]
    colours = dict.fromkeys(pattern.colour for item in scene.items for pattern in item.patterns)
    for colour in colours if (strokes.kind == LineKind.PATTERN).any() else ():
        items = (replace(i, patterns=tuple(p for p in i.patterns if p.colour == colour)) for i in scene.items)
        strokes = ruler.strokes(replace(scene, items=tuple(items)), kinds)
        own = chosen(strokes, strokes.kind == LineKind.PATTERN)
        found.append((own, shaded_colours((colour,), np.zeros_like(own.item), np.full(len(own), MIDDLE), size)))
    return found


def _shaded(
    walk: Walk, seen: _Seen, lighting: Lighting, page: Page, aura_mm: float, tolerance_mm: float, budget: Budget
) -> Fills:
    """The polygons of the picture in their colours, with all that lies on them and is seen in them."""
    seen = replace(seen, faces=_finer(seen, lighting, budget.facets))
    shades = walk.run("shades", _shades, seen, lighting)
    aura = aura_mm / seen.placement.scale
    decals, lighting = _decals(walk, seen, lighting, aura, budget)
    laid = _laid(seen, lighting, decals)
    overlays = _overlays(walk, seen, lighting, decals, aura, tolerance_mm, budget)
    return walk.run("fills", _fills, walk, seen, lighting, shades, laid, overlays, page)


def _decals(
    walk: Walk, seen: _Seen, lighting: Lighting, aura: float, budget: Budget
) -> tuple[tuple[Decals, ...], Lighting]:
    """The polygons that lie on faces, in the order in which they are painted."""
    scene, view, projected = seen.scene, seen.view, seen.projected
    found: list[Decals] = []
    if walk.calls_for("shadows"):
        from vectorplot.effects.decals.scene_decals import scene_shadows

        found.append(walk.run("shadows", scene_shadows, view, scene.items, scene.lights, projected, aura, budget))
    if walk.calls_for("mirror light"):
        from vectorplot.effects.decals.scene_decals import scene_mirror_light

        lit, doubles = walk.run("mirror light", scene_mirror_light, scene, view, projected, lighting, found[0])
        found.append(lit)
        lighting = replace(lighting, doubles=doubles)
    if walk.calls_for("patterns"):
        from vectorplot.effects.decals.decal_polygons import joined_decals
        from vectorplot.effects.decals.scene_decals import scene_patterns

        found.append(walk.run("patterns", scene_patterns, scene, view, lighting, joined_decals(*found[:1])))
    if walk.calls_for("clear shadows"):
        from vectorplot.effects.shadows.transparent_shadows import clear_shadows

        clear = partial(clear_shadows, projected=projected, budget=budget)
        found.append(walk.run("clear shadows", clear, view, scene, scene.lights, found[0] if found else None))
    return tuple(found), lighting


def _laid(seen: _Seen, lighting: Lighting, decals: tuple[Decals, ...]) -> tuple[Overlay, ...]:
    """What lies on the polygons of the picture."""
    if not decals:
        return ()
    from vectorplot.effects.decals.decal_fills import decal_fills

    return tuple(decal_fills(seen.view, lighting, some, seen.faces, seen.placement) for some in decals)


def _overlays(
    walk: Walk,
    seen: _Seen,
    lighting: Lighting,
    decals: tuple[Decals, ...],
    aura: float,
    tolerance_mm: float,
    budget: Budget,
) -> tuple[Overlay, ...]:
    """What polygons of the picture show, painted right after them and what lies on them.

    aura: the width of soft borders of shadows in the image.
    """
    found = []
    if walk.calls_for("reflections"):
        from vectorplot.effects.mirrors.reflected_decals import double_decals
        from vectorplot.effects.mirrors.reflection_fills import reflection_fills
        from vectorplot.effects.mirrors.reflections import mirrors

        shown = mirrors(seen.scene, seen.view, seen.projected)
        borders = aura if walk.calls_for("shadows") else None

        def decals_of(number: int, there: Lighting, which: Bools) -> tuple[Decals, ...]:
            return double_decals(seen.scene, seen.view, shown, number, there, which, borders, budget)

        found.append(
            walk.run("reflections", reflection_fills, seen.view, lighting, shown, decals_of, seen.faces, seen.placement)
        )
    if walk.calls_for("refraction"):
        from vectorplot.effects.glass.glass_fills import glass_fills

        found.append(
            walk.run(
                "refraction",
                glass_fills,
                seen.scene,
                seen.view,
                seen.projected,
                lighting,
                seen.faces,
                seen.placement,
                tolerance_mm,
                decals,
            )
        )
    return tuple(found)


def _fills(
    walk: Walk,
    seen: _Seen,
    lighting: Lighting,
    shades: Shades,
    laid: tuple[Overlay, ...],
    overlays: tuple[Overlay, ...],
    page: Page,
) -> Fills:
    """The polygons of the picture on the page, with what lies on them and what is painted between them."""
    view, faces = seen.view, seen.faces
    item = view.face_item[faces.source]
    opacity = opacities(seen.scene.items)[item]
    fills = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=colours_of(view, lighting, np.repeat(faces.source, np.diff(faces.offsets)), shades.total),
        opacity=opacity,
        item=item,
        kind=np.where(opacity < 1.0, int(FillKind.GLASS), int(FillKind.FACE)),
    )
    if walk.calls_for("reflections"):
        from vectorplot.effects.mirrors.reflection_fills import silvered
        from vectorplot.effects.mirrors.reflections import mirrors

        panes = np.isin(faces.source, mirrors(seen.scene, view, seen.projected).face)
        fills, laid = silvered(fills, panes, _paper(seen.scene)[0], laid)
    if walk.calls_for("refraction"):
        from vectorplot.effects.glass.glass_fills import tinted
        from vectorplot.effects.glass.glass_polygons import refracting_items

        clear = refracting_items(seen.scene, view, seen.projected)[item]
        fills, both = tinted(fills, clear, opacity, _paper(seen.scene)[0], (*laid, *overlays))
        laid, overlays = both[: len(laid)], both[len(laid) :]
    with_decals = stacked([Overlay(fills, np.arange(len(fills))), *(laid if walk.calls_for("visible fills") else ())])
    if not walk.calls_for("visible fills"):
        from vectorplot.drawing.flattened import flattened

        world, plane = seen.placement.page_from_world, lighting.plane[faces.source]
        with_decals = flattened(fills, laid, world, plane)
    return Fills.joined(*_background(seen.scene, page), stacked([with_decals, *overlays]).fills)


def _paper(scene: Scene) -> Colours:
    """(1,3) the colour of the paper."""
    return np.asarray(shades_of(scene.background or PAPER)[-1:])


def _background(scene: Scene, page: Page) -> tuple[Fills, ...]:
    """A sheet of the scene's own colour, if it names one."""
    if scene.background is None:
        return ()
    return (Fills.whole_page(page.width_mm, page.height_mm, _paper(scene)[0]),)
