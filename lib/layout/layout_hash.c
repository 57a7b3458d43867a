#include "../math/hash.h"
#include "grips.h"
#include "layout_fields.h"
#include "ports.h"
#include "times.h"
#include "words.h"

static uint64_t hash_reals(uint64_t hash, const wh_real_t reals[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        hash = wh_hash_real(hash, reals[i]);
    }
    return hash;
}

static uint64_t hash_limits(uint64_t hash, const wh_limits_t *limits) {
    return hash_reals(hash, (const wh_real_t[]){limits->speed, limits->acceleration, limits->jerk}, 3);
}

/* Hashes the members of a struct that are in this part of the hash, in the rows' order. */
static uint64_t hash_rows(uint64_t hash, int part, const wh_reader_field_t *rows, const void *of) {
    for (const wh_reader_field_t *row = rows; row->name; ++row) {
        hash = row->hashed == part ? wh_field_hash(row, of, hash) : hash;
    }
    return hash;
}

/* True if one of them is above 0. */
static bool is_any_set(int part, const wh_reader_field_t *rows, const void *of) {
    bool is_any = false;
    for (const wh_reader_field_t *row = rows; row->name; ++row) {
        is_any = is_any || (row->hashed == part && wh_field_get(row, of) > 0);
    }
    return is_any;
}

static uint64_t hash_checks(uint64_t hash, const wh_layout_t *layout) {
    hash = hash_rows(hash, WH_HASHED_CHECKS, wh_layout_tolerance_fields, &layout->grasp.tolerance);
    hash = hash_rows(hash, WH_HASHED_CHECKS, wh_layout_near_fields, &layout->grasp);
    hash = hash_rows(hash, WH_HASHED_CHECKS, wh_layout_top_fields, layout);
    return wh_hash_word(hash, (uint64_t)layout->slice_us);
}

static uint64_t hash_second(uint64_t hash, const wh_carrier_t *carrier) {
    const wh_chain_t *chain = &carrier->chain;
    const wh_chain_t *second = carrier->second ? &carrier->second->chain : NULL;
    if (second) {
        const wh_real_t reals[] = {chain->arm_heading,  chain->height,  chain->home[WH_CHAIN_YAW],
                                   second->arm_heading, second->height, second->home[WH_CHAIN_YAW]};
        hash = hash_reals(wh_hash_text(hash, "second"), reals, sizeof reals / sizeof reals[0]);
    }
    return hash;
}

/* Hashes a robot, with its axes from the first one on that is hashed nowhere else. */
static uint64_t hash_carrier(uint64_t hash, const wh_carrier_t *carrier, size_t first) {
    const wh_chain_t *chain = &carrier->chain;
    hash = wh_hash_int(hash, (int32_t)chain->kind);
    hash = chain->is_placed ? wh_hash_pose(hash, &chain->base_from_robot) : hash;
    hash = hash_reals(hash, chain->links, 2);
    for (size_t axis = first; axis < carrier->axis_count; ++axis) {
        size_t of;
        (void)wh_carrier_axis(carrier, axis, &of); /* which both arms have alike */
        const wh_real_t reals[] = {chain->travel[of].min, chain->travel[of].max, chain->home[of]};
        hash = hash_limits(hash_reals(wh_hash_word(hash, of), reals, 3), &chain->limits[of]);
    }
    hash = chain->has_flip ? wh_hash_real(hash, chain->flip_height) : hash;
    return hash_second(hash, carrier);
}

/* Hashes the other robots, and the first one's name. */
static uint64_t hash_robots(uint64_t hash, const wh_layout_t *layout) {
    for (size_t r = 0; layout->robot_count > 1 && r < layout->robot_count; ++r) {
        hash = hash_carrier(wh_hash_text(hash, layout->robots[r].name), &layout->robots[r].carrier, 0);
    }
    for (size_t g = 0; layout->robot_count > 1 && g < layout->machine.gripper_count; ++g) {
        const wh_mount_t *mount = &layout->machine.mounts[g];
        hash = wh_hash_int(hash, mount->robot);
        hash = mount->arm > 0 ? wh_hash_int(wh_hash_text(hash, "arm"), mount->arm) : hash;
    }
    return hash;
}

/* Hashes stages and pins, which not every chuck has. */
static uint64_t hash_slides(uint64_t hash, const wh_mount_t *mount) {
    if (mount->axis == WH_NONE || mount->kind == WH_MOUNT_CHUCK) {
        return hash;
    }
    hash = wh_hash_text(hash, wh_layout_mount_words[mount->kind]);
    hash = hash_reals(hash, (const wh_real_t[]){mount->travel.min, mount->travel.max}, 2);
    return hash_limits(hash, &mount->limits);
}

static uint64_t hash_machine(uint64_t hash, const wh_layout_t *layout) {
    const wh_machine_t *machine = &layout->machine;
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        const wh_travel_t *travel = &machine->robot.travel[axis];
        hash = hash_reals(hash, (const wh_real_t[]){travel->min, travel->max, machine->robot.home[axis]}, 3);
        hash = hash_limits(hash, &machine->robot.limits[axis]);
    }
    hash = hash_limits(hash, &machine->chuck_limits);
    if (machine->carrier) {
        hash = hash_carrier(wh_hash_text(hash, "carrier"), &layout->carrier, WH_ROBOT_AXES);
    }
    for (size_t r = 0; r < layout->robot_count; ++r) {
        const wh_real_t transit = layout->robots[r].transit;
        hash = transit > 0 ? wh_hash_real(wh_hash_text(hash, "transit"), transit) : hash;
        hash = transit > 0 && r > 0 ? wh_hash_word(hash, r) : hash;
    }
    hash = wh_hash_word(hash, machine->axis_count);
    hash = wh_hash_word(hash, machine->gripper_count);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        hash = wh_hash_text(hash, layout->grippers[g].name);
        hash = wh_hash_int(hash, machine->mounts[g].axis);
        hash = wh_hash_pose(hash, &machine->mounts[g].base_from_station);
        if (machine->mounts[g].is_shifted) {
            hash = wh_hash_pose(hash, &machine->mounts[g].effector_from_gripper);
        }
        hash = hash_slides(hash, &machine->mounts[g]);
        if (machine->mounts[g].arm > 0) {
            hash = wh_hash_int(wh_hash_text(hash, "arm"), machine->mounts[g].arm);
        }
    }
    return hash_robots(hash, layout);
}

static uint64_t hash_doors(uint64_t hash, const wh_layout_t *layout) {
    for (size_t d = 0; d < layout->machine.door_count; ++d) {
        const wh_door_t *door = &layout->machine.doors[d];
        hash = wh_hash_text(wh_hash_text(hash, "door"), layout->door_list[d].name);
        hash = wh_hash_vec3(hash, &door->way);
        hash = wh_hash_int(wh_hash_real(hash, door->travel), door->is_open ? 1 : 0);
        hash = hash_limits(hash, &door->limits);
    }
    return hash;
}

static uint64_t hash_stations(uint64_t hash, const wh_layout_t *layout) {
    hash = wh_hash_word(hash, layout->station_count);
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_station_t *place = &layout->places[s];
        hash = wh_hash_text(hash, layout->stations[s].name);
        hash = wh_hash_pose(hash, &place->base_from_station);
        hash = wh_hash_int(hash, place->slots);
        hash = wh_hash_real(hash, place->pitch);
        hash = wh_hash_int(hash, place->chuck);
    }
    return hash;
}

/* Hashes only fields that are set, so that layouts without them keep their hash. */
static uint64_t hash_placing(uint64_t hash, const wh_layout_t *layout) {
    const wh_cell_t *cell = &layout->cell;
    if (is_any_set(WH_HASHED_PLACING, wh_layout_top_fields, layout) ||
        is_any_set(WH_HASHED_PLACING, wh_layout_placing_fields, cell)) {
        hash = hash_rows(hash, WH_HASHED_PLACING, wh_layout_top_fields, layout);
        hash = hash_rows(hash, WH_HASHED_PLACING, wh_layout_placing_fields, cell);
    }
    const bool is_usual = !(cell->drop < WH_USUAL_DROP) && !(cell->drop > WH_USUAL_DROP);
    return is_usual ? hash : hash_rows(wh_hash_int(hash, 1), WH_HASHED_DROP, wh_layout_placing_fields, cell);
}

/* Hashes only differences from the paper's gripper, so that a layout without these sections keeps its
 * hash. */
static uint64_t hash_vacuum(uint64_t hash, const wh_vacuum_config_t *vacuum) {
    const wh_vacuum_config_t ideal = wh_vacuum_ideal();
    uint64_t place = 0;
    for (const wh_reader_field_t *row = wh_layout_vacuum_fields; row->name; ++row) {
        if (row->hashed == WH_HASHED_VACUUM) {
            if (wh_field_get(row, vacuum) != wh_field_get(row, &ideal)) {
                hash = wh_field_hash(row, vacuum, wh_hash_text(hash, "vacuum"));
                hash = wh_hash_word(hash, place);
            }
            ++place;
        }
    }
    return vacuum->debounce > 0 ? wh_hash_int(wh_hash_text(hash, "debounce"), vacuum->debounce) : hash;
}

static uint64_t hash_pads(uint64_t hash, const wh_pads_t *pads) {
    return pads->mass > 0 ? hash_rows(wh_hash_text(hash, "pads"), WH_HASHED_PADS, wh_layout_pads_fields, pads)
                          : hash;
}

static uint64_t hash_fault(uint64_t hash, const wh_fault_t *fault) {
    hash = wh_hash_text(hash, wh_fault_name(fault->kind));
    hash = wh_hash_int(hash, fault->target);
    hash = wh_hash_int(hash, fault->other);
    hash = wh_hash_real(hash, fault->value);
    hash = wh_hash_pose(hash, &fault->offset);
    hash = wh_hash_word(hash, (uint64_t)fault->from);
    return wh_hash_word(hash, (uint64_t)fault->until);
}

static uint64_t hash_part(uint64_t hash, const wh_part_t *part) {
    const wh_convex_t *convex = &part->convex;
    hash = wh_hash_int(wh_hash_int(wh_hash_int(hash, (int32_t)part->kind), part->owner), part->slot);
    hash = wh_hash_pose(wh_hash_int(hash, (int32_t)convex->kind), &convex->body_from_shape);
    if (convex->kind != WH_CONVEX_MESH) {
        return wh_hash_vec3(hash, &convex->half);
    }
    for (size_t i = 0; i < convex->point_count; ++i) {
        hash = wh_hash_vec3(hash, &convex->points[i]);
    }
    return wh_hash_word(hash, convex->point_count);
}

uint64_t wh_layout_world_hash(const wh_layout_t *layout) {
    const wh_world_config_t *world = &layout->world;
    if (!layout->collision) {
        return 0;
    }
    uint64_t hash = hash_part(WH_HASH_START, &(wh_part_t){WH_PART_WAFER, 0, 0, world->wafer});
    for (size_t i = 0; i < world->part_count; ++i) {
        hash = hash_part(hash, &world->parts[i]);
    }
    hash = hash_rows(hash, WH_HASHED_ARM, wh_layout_arm_fields, &layout->shapes.arm);
    for (size_t robot = 1; robot < layout->robot_count; ++robot) {
        hash = hash_rows(hash, WH_HASHED_ARM, wh_layout_arm_fields, &layout->robots[robot].arm);
    }
    return hash_reals(hash, world->limits, WH_CLEARANCES);
}

/* Hashes only grippers that have another grip than vacuum. */
static uint64_t hash_grips(uint64_t hash, const wh_layout_t *layout) {
    bool is_new = false;
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        is_new = is_new || layout->grips[g].kind != WH_GRIP_VACUUM;
    }
    if (!is_new) {
        return hash;
    }
    const wh_grips_parts_t parts = wh_layout_grips(layout);
    return wh_gripping_hash(&parts, layout->machine.gripper_count, layout->wafer_count,
                            wh_hash_text(hash, "grips"));
}

static uint64_t hash_loaded(uint64_t hash, const wh_layout_t *layout) {
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        const wh_limits_t limits = wh_layout_loaded(layout, g);
        if (limits.speed > 0 || limits.acceleration > 0 || limits.jerk > 0) {
            hash = hash_limits(wh_hash_int(wh_hash_word(hash, 'l'), (int32_t)g), &limits);
        }
    }
    return hash;
}

static uint64_t hash_points(uint64_t hash, const wh_layout_vias_t *vias, size_t station, size_t axis_count) {
    for (size_t i = 0; i < vias->count; ++i) {
        const wh_layout_via_t *via = &vias->at[i];
        hash = wh_hash_real(wh_hash_word(hash, station + 1), via->point.blend);
        for (size_t axis = 0; axis < axis_count; ++axis) {
            hash = wh_hash_real(wh_hash_int(hash, via->is_given[axis] ? 1 : 0), via->point.q[axis]);
        }
    }
    return hash;
}

/* Hashes the first robot's points like those of a single robot. */
static uint64_t hash_vias(uint64_t hash, const wh_layout_t *layout) {
    for (size_t s = 0; s < layout->station_count; ++s) {
        for (size_t r = 0; r < layout->robot_count; ++r) {
            const wh_layout_vias_t *vias = wh_layout_vias_of(layout, s, r);
            hash = vias->count > 0 && r > 0 ? wh_hash_word(hash, r) : hash;
            hash =
                hash_points(hash, vias, s,
                            layout->machine.carrier ? layout->robots[r].carrier.axis_count : WH_ROBOT_AXES);
        }
    }
    return hash;
}

/* Hashes the robots that are times alone, and the doors through which they come. */
static uint64_t hash_timed(uint64_t hash, const wh_flow_tool_t *tool) {
    if (!tool) {
        return hash;
    }
    hash = wh_flow_tool_hash(tool, wh_hash_text(hash, "timed"));
    for (size_t i = 0; i < tool->robot_count * tool->station_count; ++i) {
        hash = wh_hash_int(hash, tool->doors[i].is_real ? tool->doors[i].number : WH_NONE);
    }
    return hash;
}

/* Recordings and messages carry this hash: new fields go to the end, and only if they differ from the
 * default. */
uint64_t wh_layout_hash(const wh_layout_t *layout) {
    if (layout->tool) {
        return wh_flow_tool_hash(layout->tool, WH_HASH_START);
    }
    uint64_t hash = hash_checks(WH_HASH_START, layout);
    hash = hash_machine(hash, layout);
    hash = hash_stations(hash, layout);
    hash = wh_hash_word(hash, layout->wafer_count);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        hash = wh_hash_text(hash, layout->wafers[w].name);
        hash = wh_hash_pose(hash, &layout->start[w].base_from_wafer);
    }
    hash = hash_vacuum(hash, &layout->physics.vacuum);
    hash = hash_pads(hash, &layout->physics.pads);
    for (size_t i = 0; i < layout->physics.fault_count; ++i) {
        hash = hash_fault(hash, &layout->physics.faults[i]);
    }
    hash = hash_placing(hash, layout);
    if (layout->cell.thickness > 0) {
        hash = wh_hash_real(wh_hash_text(hash, "faces"), layout->cell.thickness);
    }
    hash = hash_loaded(hash, layout);
    if (layout->scanner_count > 0) {
        const wh_scanning_t scanning = wh_layout_scanning(layout);
        hash = wh_scanning_hash(&scanning, layout->wafer_count, wh_hash_text(hash, "sensor"));
    }
    if (layout->beam_count > 0) {
        const wh_latching_t latching = wh_layout_latching(layout);
        hash = wh_latching_hash(&latching, layout->machine.gripper_count, layout->wafer_count,
                                wh_hash_text(hash, "beams"));
    }
    hash = hash_vias(hash_doors(hash_grips(hash, layout), layout), layout);
    hash = wh_layout_hash_ports(layout, wh_layout_hash_times(layout, hash));
    hash = hash_timed(hash, layout->timed);
    return layout->patterns ? wh_hash_word(wh_hash_text(hash, "patterns"), layout->patterns_hash) : hash;
}
