#!/usr/bin/env python3
"""Checks that names which gave way to those of the trade do not come back.

usage: retired_words.py TOP
WORDS are looked for everywhere: in code, comments, documents and names of files. IDENTIFIERS are common words too, so
they are looked for in C++ without comments and strings; PHRASES in comments and docstrings, those of PAGE_PHRASES in
pages of docs/ too. CHANGELOG.md, docs/decisions and docs/evidence tell the past and are left out.
Exit status: 0 none is found, 1 some are, 2 there are no sources.
"""
import ast
import io
import pathlib
import re
import sys
import tokenize

FOLDERS = ("firmware", "hal", "boards", "host_tools", "tests", "docs", "cmake")
ENDINGS = (".hpp", ".cpp", ".md", ".py", ".txt", ".cmake", ".sh", ".ts", ".mjs")
# Old name: what to say instead.
WORDS = {
    "TipFloor": "DropCutter", "tip_floor": "drop_cutter", "SurfaceModel": "PartModel", "surface_model": "part_model",
    "surface_offset": "part_model", "surface_passes": "finishing", "CertifiedPasses": "GougeFreePathFitter",
    "certified_pass": "gouge_free_path", "PassBand": "ToleranceBand", "FollowedBall": "ContactTracker",
    "followed_ball": "contact_tracker", "StandingMetal": "StockHeightMap", "standing_metal": "stock_height_map",
    "MetalThickness": "ResidualThickness", "metal_thickness": "residual_thickness", "CutDepth": "AxialDepthTracker",
    "SweptBalls": "SweptVolume", "swept_balls": "swept_volume", "FacetCoverage": "MeshScallopCheck",
    "facet_coverage": "mesh_scallop_check", "PlaceCoverage": "ScallopAtPoint", "place_coverage": "scallop_at_point",
    "StripRidge": "LoopScallop", "strip_ridge": "loop_scallop", "LevelInterval": "LoopSpacing",
    "level_interval": "loop_spacing", "path_interval": "stepover", "scallop_width": "stepover", "isocurve_stepover": "stepover",
    "lay_on_floor": "drop_path", "FloorPathSettings": "ClPathSettings", "floor_path": "cl_path", "FloorCutter": "PocketPathWriter",
    "floor_cutter": "pocket_path_writer", "FloorFollower": "ClPathFitter", "floor_follower": "cl_path_fitter",
    "FloorContact": "DropCutter", "floor_contact": "drop_cutter", "FlatContact": "DropCutter", "GridDropCutter": "DropCutter",
    "flat_contact": "drop_cutter", "grid_drop_cutter": "drop_cutter", "FlatEndDropCutter": "DropCutter", "GridHeightBounds": "HeightBounds", "FloorBounds": "HeightBounds", "floor_bounds": "height_bounds",
    "FloorBend": "HeightBounds", "floor_bend": "height_bounds", "FloorReach": "ToolAccess", "floor_reach": "tool_access",
    "NeighbourBound": "IsocurveSpacingBound", "neighbour_bound": "isocurve_spacing_bound", "EdgeGuard": "EdgeGougeCheck",
    "edge_guard": "edge_gouge_check", "RollingBall": "MoveClearanceBound", "rolling_ball": "move_clearance_bound",
    "BallDirections": "ApproachDirections", "ball_directions": "approach_directions", "HiddenPlaces": "VisibilityFromAbove",
    "hidden_places": "visibility_from_above", "TopMap": "SilhouetteMap", "top_map": "silhouette_map", "HeightOver": "SurfaceHeightMap",
    "height_over": "surface_height_map", "LevelSlices": "WaterlineSlices", "level_slice": "waterline_slices",
    "LevelRougher": "WaterlineRougher", "level_rougher": "waterline_rougher", "rough_levels": "waterline_roughing",
    "rest_parts": "rest_regions", "RestPlace": "UncutRegion", "rest_material": "uncut_regions", "CreaseLine": "PencilCurve",
    "crease_lines": "pencil_curves", "cliff_detours": "pencil_detours",
    "slow_descents": "limit_plunge_feed", "corner_spurs": "corner_cleanup", "way_within": "path_inside_region",
    "free_way": "is_path_clear", "link_along": "link_along_pass", "nested_reach": "rest_offset_between_tools",
    "nested_tools": "rest_between_tools", "PocketMoves": "ClPathWriter", "PocketToolpathWriter": "ClPathWriter", "GridMoves": "ToolpathWriter", "GridToolpathWriter": "ToolpathWriter",
    "LevelMoves": "LayerToolpathWriter", "TipMoves": "ToolpathWriter", "GridMoveWriter": "ToolpathWriter", "StepTable": "DensityTable", "even_passes": "equal_scallop_passes",
    "PassTracer": "OffsetCurveTrimmer", "pass_tracer": "offset_curve_trimmer", "MarginLattice": "ContourLattice",
    "margin_lattice": "contour_lattice", "domain_outline": "domain_contour", "ReachSearch": "LowestPositionSearch",
    "reach_search": "lowest_position_search", "LowestReach": "ReachableHeight", "lowest_reach": "reachable_height",
    "LowerBall": "LowerPositionProof", "lower_ball": "lower_position_proof", "clearance_along": "move_clearance",
    "kept_off_edges": "moved_clear_of_edges", "close_gaps": "add_missing_passes", "close_rims": "add_rim_passes",
    "bare_place": "uncovered_point", "told_apart": "resolution", "told_at_once": "quick_verdict", "told_length": "lookup_spacing",
    "feel_moves": "track_moves", "rest_on_mesh": "drop_ball", "top_of_mesh": "height_at", "touches_freely": "is_clear_at_contact",
    "stands_free": "is_clear", "spares_edges": "clears_edges", "guard_edges": "check_edge_gouges", "kDescent": "kPlungingCut",
    "JointShare": "JunctionShare", "joint_share": "junction_share", "mind_joints": "apply_junction_limits",
    "reckons_with": "is_covered_by", "LookOut": "MinSpeedWindow", "kNoRest": "kNoContact",
}
IDENTIFIERS = {
    "Budget": "ToleranceSplit", "Feet": "CcParameterList", "Foot": "CcParameters", "Joint": "Junction", "Lack": "EdgeViolation",
    "Laid": "ProjectedPass", "NearestPlace": "NearestPoint", "Ridges": "IsocurveScallop", "Stand": "BallPosition",
    "Barred": "BlockedPart", "bars_shank": "blocks_shank", "feel": "track", "feeler": "probe", "felt": "tracked", "laid": "project",
    "lay": "project_pass", "go_round": "link_around", "hurry": "flush_if_short", "kHere": "kContinue", "kDrop": "kRetractAndDrop",
    "rolls_freely": "is_move_between_contacts_clear", "worth": "resolution", "told": "lookup_spacing", "bare": "uncovered",
    "cushion": "clearance_reserve", "metal": "stock", "stands": "remains", "kept_off": "with_clearance", "askew": "at_an_angle",
}
# In comments of C++, TypeScript and Python, and in docstrings.
PHRASES = {
    "told apart": "inexact", "let down": "dropped", "askew": "at an angle", "felt": "tracked", "feel": "track", "feels": "tracks",
    "upright": "vertical", "metal": "stock", "stands": "is", "standing": "uncut", "stood": "was", "told": "given", "tells": "returns",
    "bare": "uncovered", "speak": "send", "speaks": "sends", "hopeful": "approximate", "for ever": "endlessly",
    "goes on": "continues", "gone on": "resumed", "looks up": "faces up", "looks down": "faces down", "look down": "face down",
    "look out": "look ahead", "looks out": "looks ahead", "way within": "path inside", "under its eyes": "while it reads",
}
PAGE_PHRASES = ("told", "let down", "askew", "felt", "feel", "feels", "metal", "tells", "hopeful", "for ever", "under its eyes", "upright",
                "stands", "stood", "bare", "speaks", "goes on", "gone on", "looks up", "looks down", "look out", "looks out", "way within")
COMMENT = re.compile(r"//.*|/\*.*|^ *\* .*")  # of one line
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"', re.DOTALL)


def pattern(words):
    return re.compile(r"(?<!\w)(%s)(?=(?:s|_test|_property_test|_drop|_gap|_outline|_section|_trim)?(?!\w))" % "|".join(words))


PHRASE, PAGE_PHRASE = (re.compile(r"\b(?:%s)\b" % "|".join(words), re.IGNORECASE) for words in (PHRASES, PAGE_PHRASES))
WORD, IDENTIFIER = pattern(WORDS), re.compile(r"\b(?:%s)\b" % "|".join(IDENTIFIERS))


def python_comments(text):
    """Comments and docstrings, each at its line; all else is left blank."""
    lines = [""] * (text.count("\n") + 1)
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            lines[token.start[0] - 1] = token.string
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node, clean=False):
            for line in range(node.body[0].lineno - 1, node.body[0].end_lineno):
                lines[line] = text.split("\n")[line]
    return "\n".join(lines)


def files_of(top):
    for folder in FOLDERS:
        for file in sorted((top / folder).rglob("*")):
            if file.suffix in ENDINGS and not {"decisions", "evidence", "node_modules"} & set(file.parts) and file.name not in (pathlib.Path(__file__).name, "checks_fail_test.py"):
                yield file


def complaints(file, place):
    for word in WORD.findall(place):
        yield f"{place}: {word} is now {WORDS[word]}"
    text = file.read_text()
    code = COMMENT_OR_STRING.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text) if file.suffix in (".hpp", ".cpp") else ""
    commented = file.suffix in (".hpp", ".cpp", ".ts", ".mjs")
    comments = "\n".join("".join(COMMENT.findall(line)) for line in text.split("\n")) if commented else ""
    comments = python_comments(text) if file.suffix == ".py" else comments
    page = text if file.suffix == ".md" else ""
    for names, searched, found in ((WORDS, text, WORD), (IDENTIFIERS, code, IDENTIFIER), (PHRASES, comments, PHRASE),
                                   (PHRASES, page, PAGE_PHRASE)):
        for match in found.finditer(searched):
            line = searched.count("\n", 0, match.start()) + 1
            yield f"{place}:{line}: {match.group()} is now {names.get(match.group()) or names[match.group().lower()]}"


def main(arguments):
    top = pathlib.Path(arguments[1])
    count, found = 0, []
    for file in files_of(top):
        count += 1
        found += complaints(file, file.relative_to(top).as_posix())
    if not count:
        print(f"retired_words: no sources below {top}", file=sys.stderr)
        return 2
    print("\n".join(found) if found else f"retired_words: {count} files, none of {len(WORDS) + len(IDENTIFIERS) + len(PHRASES)} words")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
