"""Parameters that `make test` runs of tests with many dear ones; the others are slow tests, as the rule is the same."""

from __future__ import annotations

from fnmatch import fnmatchcase

import pytest

PARTS = "tests/mechanisms/automatic"
SAMPLES: dict[str, tuple[str, ...]] = {
    f"{PARTS}/test_engines.py::test_a_shaft_and_what_it_carries_turn_without_force_and_couple": (
        *("I1-*", "V2-*", "flat-4-*"),
    ),
    f"{PARTS}/test_engines.py::test_pistons_stay_in_their_liners_and_clear_of_the_shaft": ("SINGLE", "V_TWO"),
    f"{PARTS}/test_engines.py::test_other_radial_engines_pass": ("3",),
    f"{PARTS}/test_machines_along.py::test_engines_with_several_valves_pass": ("I4-1",),
    f"{PARTS}/test_stands.py::test_in_a_turned_world_it_is_the_same_stand": ("2.5",),
    f"{PARTS}/test_stands.py::test_no_stand_tips_before_ten_degrees": ("rocker", "hanging"),
    f"{PARTS}/test_stands.py::test_what_moves_weighs_the_same_however_it_stands": ("wall",),
    f"{PARTS}/test_gears.py::test_what_fills_a_layer_leaves_wheels_to_tubes": ("*-0.7",),
    f"{PARTS}/test_pins.py::test_one_pin_with_a_roller_in_each_slot": ("*-0.9",),
    f"{PARTS}/test_slides.py::test_two_guides_along_one_line_get_one_rail": ("*-30.0",),
    f"{PARTS}/test_gears.py::test_teeth_pass_each_other_with_play_and_in_phase": ("teeth0",),
    f"{PARTS}/test_plates.py::test_what_hunts_found": ("7000421-*", "7000721-*"),
    f"{PARTS}/test_plates.py::test_a_rod_lies_where_a_bar_would": ("30.0--2.0",),
    f"{PARTS}/test_rolling.py::test_two_wheels_run_on_one_road": ("*-1.1",),
    f"{PARTS}/test_slots.py::test_a_slotted_plate_reaches_beyond_the_slide_that_carries_its_pin": ("30.0",),
    f"{PARTS}/test_springs_and_free_bodies.py::"
    "test_what_the_film_draws_of_a_spring_meets_no_plate_and_no_other_spring": ("30.0--2.0",),
    f"{PARTS}/test_gears.py::test_pinion_whose_two_mates_overlap_is_two": ("0.5", "-1.2"),
    f"{PARTS}/test_pins.py::test_stop_pins_meet_at_both_ends_of_the_way": ("0.1-True",),
    f"{PARTS}/test_rolling.py::test_none_of_its_parts_touch": ("cup",),
    f"{PARTS}/test_rolling.py::test_tracks_are_sound_solids": ("bowl", "table"),
    f"{PARTS}/test_pins.py::test_bolts_of_a_load_at_or_beside_a_joint_clear_its_hardware": (
        *("places0-*", "places3-*"),
    ),
    "tests/drawing/test_drawing.py::test_every_kind_can_be_drawn": ("*-two_bodies",),
    "tests/drawing/test_drawing.py::test_every_kind_of_force_can_be_drawn": ("*-two_bodies",),
    "tests/mechanisms/test_new.py::test_models_of_a_new_mechanism_are_clear": ("1:7",),
    "tests/mechanisms/test_solve_stage.py::test_digits_are_those_of_one_built_so": (
        *(
            "*pendulum",
            "four_bar*",
            "belt*",
            "cam*",
            "*crank",
            "quarter_car",
            "planetary_gear",
            "geneva*",
            "*leg",
            "v6",
        ),
    ),
    "tests/project/test_injection.py::test_a_stage_refuses_a_link_in_place_of_a_folder_of_results": (
        *("four_bar", "four_bar/frames"),
    ),
    "tests/render/film/test_framing.py::"
    "test_every_body_that_moves_stays_in_the_frame_over_the_whole_film_and_fills_it": ("*-mount1",),
    "tests/render/film/test_writing.py::test_words_have_a_contrast_of_four_and_a_half_to_whatever_is_behind_them": (
        *("*-behind0", "*-behind3"),
    ),
    "tests/render/frames/test_blender_child.py::test_each_picture_may_crash_once": ("SIGSEGV",),
    "tests/render/frames/test_film_render.py::test_pins_are_within_a_pixel_of_where_the_solver_has_them": (
        *("four_bar", "standing"),
    ),
    "tests/render/frames/test_film_resumes.py::test_a_film_goes_on_where_it_was_stopped": ("SIGTERM", "SIGKILL"),
    "tests/render/frames/test_full_disk.py::test_a_limit_on_the_size_of_files": ("film",),
    "tests/saving/test_saving.py::test_every_kind_of_force_comes_back": ("*-two_bodies",),
    "tests/shared/test_geneva_shapes.py::test_wheel_passes_the_locking_disc_without_touching_it": ("3-*", "6-*"),
    "tests/shared/test_leg_shapes.py::test_outlines_make_valid_solids_of_any_size": ("*-0.1",),
    "tests/shared/test_lineage.py::test_whatever_ends_run_all_ends_its_stages": ("make-15", "make-9", "the night-9"),
    "tests/shared/test_shapes.py::test_every_letter_engraves": ("A", "B", "O", "8"),
    "tests/shared/test_shapes.py::test_socket_screw": ("1.6", "5", "24"),
    "tests/studio/night/test_night.py::test_crashed_steps_are_started_once_more": ("crash",),
    "tests/studio/night/test_night.py::test_whatever_ends_a_night_ends_its_stages_and_status_tells": ("15", "9"),
    "tests/studio/test_fetch.py::test_a_killed_transfer_goes_on": ("9", "None"),
}
"""Patterns of the parameters that stay, by test; a parameter that is new is slow until a pattern fits it."""


def is_left_out(nodeid: str) -> bool:
    """Return True if another parameter of the same test holds its rule in ``make test``."""
    test, _, parameters = nodeid.partition("[")
    kept = SAMPLES.get(test)
    return kept is not None and not any(fnmatchcase(parameters.removesuffix("]"), pattern) for pattern in kept)


def mark(items: list[pytest.Item]) -> None:
    """Mark what is left out as slow; of a test none of whose parameters fits, all stay."""
    stay = {item.nodeid.partition("[")[0] for item in items if not is_left_out(item.nodeid)}
    for item in items:
        if is_left_out(item.nodeid) and item.nodeid.partition("[")[0] in stay:
            item.add_marker("slow")
