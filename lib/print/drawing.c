#include "drawing.h"

#include <string.h>

#include "../layout/arms.h"
#include "../layout/axes.h"
#include "../layout/inks.h"
#include "../layout/outline.h"
#include "../math/trig.h"
#include "../text/svg.h"

/* The picture fills the window's width. Widths of lines and letters are fractions of it. */
#define LINES_PER_WIDTH 1300
#define LETTERS_PER_WIDTH 95

/* Both views, in mm of the cell: the box that holds all of it, and the sizes that follow from it. */
typedef struct {
    const wh_feasibility_t *check;
    FILE *out;
    wh_vec3_t low, high;
    double width, height, margin, letter;
    wh_outline_t outline;
} drawing_t;

/* --------------------------------------------------------------------------------------------------- size */

static void grow(drawing_t *d, wh_vec3_t low, wh_vec3_t high) {
    d->low = wh_vec3(low.x < d->low.x ? low.x : d->low.x, low.y < d->low.y ? low.y : d->low.y,
                     low.z < d->low.z ? low.z : d->low.z);
    d->high = wh_vec3(high.x > d->high.x ? high.x : d->high.x, high.y > d->high.y ? high.y : d->high.y,
                      high.z > d->high.z ? high.z : d->high.z);
}

static const wh_convex_t *convex_of(const wh_layout_t *layout, size_t part) {
    return part < layout->world.part_count ? &layout->world.parts[part].convex : &layout->world.wafer;
}

/* Parts and wafers together; 0 if the layout has more parts than can be checked. */
static size_t count_parts(const wh_feasibility_t *check) {
    return check->has_parts ? check->layout->world.part_count + check->layout->wafer_count : 0;
}

static const wh_chain_t *chain_of(const wh_layout_t *layout, size_t robot) {
    const wh_carrier_t *carrier = wh_machine_carrier(&layout->machine, robot, NULL);
    return carrier ? &carrier->chain : NULL;
}

/* Where theta's axis is, at one end or the other of the rail if there is one. */
static wh_vec3_t foot_of(const wh_layout_t *layout, size_t robot, int end) {
    const wh_chain_t *chain = chain_of(layout, robot);
    wh_vec3_t foot = wh_vec3(0, 0, 0);
    if (chain) {
        const wh_travel_t *rail = &chain->travel[WH_CHAIN_RAIL];
        foot.x = !chain->has_rail ? 0 : end == 0 ? rail->min : rail->max;
        foot = chain->is_placed ? wh_pose_point(&chain->base_from_robot, &foot) : foot;
    }
    return foot;
}

static void measure(drawing_t *d) {
    const wh_layout_t *layout = d->check->layout;
    for (size_t i = 0; i < 2 * wh_machine_robots(&layout->machine); ++i) {
        const wh_real_t reach = wh_axis_reach(&layout->machine, i / 2).max;
        const wh_vec3_t foot = foot_of(layout, i / 2, (int)(i % 2));
        grow(d, wh_vec3(foot.x - reach, foot.y - reach, 0), wh_vec3(foot.x + reach, foot.y + reach, 0));
    }
    for (size_t part = 0; part < count_parts(d->check); ++part) {
        const wh_pose_t pose = wh_feasibility_place(d->check, (int32_t)part);
        wh_vec3_t low;
        wh_vec3_t high;
        wh_convex_bounds(convex_of(layout, part), &pose, &low, &high);
        grow(d, low, high);
    }
    const double x = (double)(d->high.x - d->low.x);
    const double y = (double)(d->high.y - d->low.y);
    const double z = (double)(d->high.z - d->low.z);
    d->margin = x / 20;
    d->width = 2 * x + 3 * d->margin;
    d->letter = d->width / LETTERS_PER_WIDTH;
    d->height = (y > z ? y : z) + 2 * d->margin + 5 * d->letter;
}

/* -------------------------------------------------------------------------------------------------- style */

static void print_style(const drawing_t *d) {
    fprintf(d->out,
            "<style>\n.paper { fill: #ffffff } .rule { stroke: #9aa3ad; fill: none } .scale { stroke: "
            "#1c2733; fill: none }\n"
            "text { font-family: system-ui, 'DejaVu Sans', sans-serif; font-size: %.1fpx; fill: #1c2733 }\n"
            ".label { text-anchor: middle; font-size: %.1fpx; paint-order: stroke; stroke: #ffffff; "
            "stroke-width: %.1f; "
            "stroke-opacity: .75 }\n"
            ".title { font-weight: bold } polygon:hover { fill-opacity: .75 }\n",
            d->letter, 0.85 * d->letter, d->letter / 4);
    for (const wh_ink_look_t *ink = wh_ink_looks; ink < wh_ink_looks + WH_INKS; ++ink) {
        fprintf(d->out, ".%s { fill: #%06x; stroke: #%06x; fill-opacity: %s }\n", ink->class,
                ink->drawn.light, ink->drawn.light, ink->opacity);
    }
    fputs(".found { fill: #d11a2a; stroke: #d11a2a; fill-opacity: .6 }\n"
          "@media (prefers-color-scheme: dark) {\n.paper { fill: #14181d } text { fill: #e4e9ee } "
          ".label { stroke: #14181d } .rule { stroke: #55606b } .scale { stroke: #e4e9ee }\n",
          d->out);
    /* A viewer that knows no preference takes the light ones. */
    for (const wh_ink_look_t *ink = wh_ink_looks; ink < wh_ink_looks + WH_INKS; ++ink) {
        fprintf(d->out, ".%s { fill: #%06x; stroke: #%06x }\n", ink->class, ink->drawn.dark, ink->drawn.dark);
    }
    fputs(".found { fill: #ff5d6c; stroke: #ff5d6c }\n}\n</style>\n", d->out);
}

/* -------------------------------------------------------------------------------------------------- parts */

static wh_part_ink_t ink_of(const wh_layout_t *layout, size_t part) {
    return part < layout->world.part_count ? wh_ink_of(&layout->world.parts[part]) : WH_INK_WAFER;
}

/* The name of the group that the part belongs to. */
static const char *group_of(const wh_layout_t *layout, size_t part, wh_part_ink_t ink) {
    if (ink == WH_INK_WALL || ink == WH_INK_WAFER) {
        return ink == WH_INK_WALL ? "obstacles" : "wafers";
    }
    const int32_t owner = layout->world.parts[part].owner;
    if (ink == WH_INK_SHELL || ink == WH_INK_LEDGE) {
        return layout->stations[owner].name;
    }
    if (ink == WH_INK_ARM && layout->robot_count > 1) {
        return layout->robots[layout->arms[owner / (int32_t)WH_ARM_BODIES].robot].name;
    }
    return ink == WH_INK_ARM ? "robot" : layout->grippers[owner].name;
}

static bool is_found(const wh_feasibility_t *check, size_t part) {
    for (size_t i = 0; i < check->count; ++i) {
        const int32_t *parts = check->findings[i].parts;
        if (parts[0] == (int32_t)part || parts[1] == (int32_t)part) {
            return true;
        }
    }
    return false;
}

/* A wafer that lies face down has a dashed outline, and says so. */
static void draw_part(drawing_t *d, wh_projection_t view, size_t part, wh_part_ink_t ink) {
    const wh_layout_t *layout = d->check->layout;
    const wh_pose_t pose = wh_feasibility_place(d->check, (int32_t)part);
    const bool is_face_down = ink == WH_INK_WAFER && pose.R.m[2][2] < 0;
    wh_outline_draw(&d->outline, view, convex_of(layout, part), &pose);
    fprintf(d->out, "<polygon class=\"%s\" ", is_found(d->check, part) ? "found" : wh_ink_looks[ink].class);
    if (is_face_down) {
        fprintf(d->out, "stroke-dasharray=\"%.1f\" ", d->letter / 2);
    }
    fputs("points=\"", d->out);
    for (size_t i = 0; i < d->outline.count; ++i) {
        fprintf(d->out, "%s%.1f,%.1f", i > 0 ? " " : "", d->outline.spots[i].x, d->outline.spots[i].y);
    }
    fputs("\"><title>", d->out);
    wh_svg_text(d->out, wh_layout_part_name(layout, (int32_t)part));
    fputs(is_face_down ? ", face down</title></polygon>\n" : "</title></polygon>\n", d->out);
}

/* Draws the parts with inks `first` to `last`, in groups. */
static void draw_parts(drawing_t *d, wh_projection_t view, wh_part_ink_t first, wh_part_ink_t last) {
    const wh_layout_t *layout = d->check->layout;
    const char *group = NULL;
    for (size_t part = 0; part < count_parts(d->check); ++part) {
        const wh_part_ink_t ink = ink_of(layout, part);
        if (ink < first || ink > last) {
            continue;
        }
        const char *wanted = group_of(layout, part, ink);
        if (wanted != group) {
            fputs(group ? "</g>\n<g><title>" : "<g><title>", d->out);
            wh_svg_text(d->out, wanted);
            fputs("</title>\n", d->out);
            group = wanted;
        }
        draw_part(d, view, part, ink);
    }
    fputs(group ? "</g>\n" : "", d->out);
}

/* ------------------------------------------------------------------------------------------------- labels */

static void label_at(wh_svg_labels_t *labels, wh_projection_t view, wh_vec3_t r, double down,
                     const char *name) {
    const wh_spot_t spot = wh_outline_spot(view, r);
    wh_svg_label(labels, spot.x, spot.y + down, name);
}

static void label_stations(const drawing_t *d, wh_projection_t view, wh_svg_labels_t *labels) {
    const wh_layout_t *layout = d->check->layout;
    for (size_t s = 0; s < layout->station_count; ++s) {
        const wh_station_t *place = &layout->places[s];
        const wh_pose_t last = wh_station_slot(place, place->slots);
        label_at(labels, view, last.r, view == WH_VIEW_TOP ? 0.3 * d->letter : -1.8 * d->letter,
                 layout->stations[s].name);
    }
}

/* Labels stand at the lower edge of each obstacle, inside if there is room. */
static void label_obstacles(const drawing_t *d, wh_projection_t view, wh_svg_labels_t *labels) {
    const wh_layout_t *layout = d->check->layout;
    for (size_t part = 0; part < layout->world.part_count; ++part) {
        const wh_convex_t *convex = &layout->world.parts[part].convex;
        if (ink_of(layout, part) == WH_INK_WALL) {
            wh_vec3_t low;
            wh_vec3_t high;
            wh_convex_bounds(convex, &convex->body_from_shape, &low, &high);
            low.x = (low.x + high.x) / 2;
            label_at(labels, view, low, -0.5 * d->letter, wh_layout_part_name(layout, (int32_t)part));
        }
    }
}

static void label_all(const drawing_t *d, wh_projection_t view) {
    const wh_layout_t *layout = d->check->layout;
    wh_svg_labels_t labels = {
        .out = d->out, .size = 0.85 * d->letter, .left = (double)d->low.x, .right = (double)d->high.x};
    label_stations(d, view, &labels);
    for (size_t g = 0; g < layout->machine.gripper_count; ++g) {
        if (layout->grippers[g].station == WH_NONE) {
            label_at(&labels, view, d->check->base_from_grippers[g].r,
                     view == WH_VIEW_TOP ? 0.3 * d->letter : -0.8 * d->letter, layout->grippers[g].name);
        }
    }
    for (size_t r = 0; r < wh_machine_robots(&layout->machine); ++r) {
        wh_vec3_t foot = r == 0 ? d->check->links.bodies[WH_ARM_BASE].r : foot_of(layout, r, 0);
        foot.z += wh_layout_lowest(layout, r) / 2;
        label_at(&labels, view, foot, 0.3 * d->letter,
                 layout->robot_count > 1 ? layout->robots[r].name : "robot");
    }
    label_obstacles(d, view, &labels);
}

/* -------------------------------------------------------------------------------------------------- views */

/* The circles that the end-effector reaches with theta's axis there. */
static void draw_circles(const drawing_t *d, size_t robot, const wh_vec3_t *foot) {
    const wh_layout_t *layout = d->check->layout;
    const wh_travel_t reach = wh_axis_reach(&layout->machine, robot);
    for (int end = 0; end < 2; ++end) {
        const double radius = (double)(end == 0 ? reach.min : reach.max);
        char place[80] = "";
        if (layout->machine.carrier) {
            (void)snprintf(place, sizeof place, " cx=\"%.1f\" cy=\"%.1f\"", (double)foot->x,
                           (double)-foot->y);
        }
        fprintf(d->out,
                "<circle class=\"rule\"%s r=\"%.1f\" stroke-dasharray=\"%.1f\"><title>R = %g mm: how %s the "
                "robot reaches"
                "</title></circle>\n",
                place, radius, d->letter / 2, radius, end == 0 ? "near" : "far");
    }
}

static void draw_robot(const drawing_t *d, size_t robot) {
    const wh_layout_t *layout = d->check->layout;
    const wh_vec3_t foot = foot_of(layout, robot, 0);
    const wh_chain_t *chain = chain_of(layout, robot);
    draw_circles(d, robot, &foot);
    if (chain && chain->has_rail) {
        const wh_vec3_t far = foot_of(layout, robot, 1);
        draw_circles(d, robot, &far);
        fprintf(d->out, "<path class=\"rule\" d=\"M%.1f %.1fL%.1f %.1f\"><title>the rail</title></path>\n",
                (double)foot.x, (double)-foot.y, (double)far.x, (double)-far.y);
    }
}

static void draw_travel(const drawing_t *d, wh_projection_t view) {
    if (view == WH_VIEW_SIDE) {
        fprintf(d->out, "<path class=\"rule\" d=\"M%.1f 0H%.1f\"/>\n", (double)d->low.x, (double)d->high.x);
        return;
    }
    for (size_t robot = 0; robot < wh_machine_robots(&d->check->layout->machine); ++robot) {
        draw_robot(d, robot);
    }
}

static void draw_view(drawing_t *d, wh_projection_t view, double x, double lowest) {
    fprintf(d->out, "<g transform=\"translate(%.1f %.1f)\">\n", x - (double)d->low.x,
            d->height - d->margin - 2.5 * d->letter + lowest);
    draw_travel(d, view);
    draw_parts(d, view, WH_INK_WALL, WH_INK_LEDGE);
    draw_parts(d, view, WH_INK_WAFER, WH_INK_WAFER);
    draw_parts(d, view, WH_INK_ARM, WH_INK_BLADE);
    label_all(d, view);
    fputs("</g>\n", d->out);
}

/* Draws a scale of a round length, about a tenth of the picture, and the meaning of the colours. */
static void draw_scale(const drawing_t *d) {
    static const double steps[] = {1, 2, 5, 10};
    const double wanted = d->width / 10;
    double length = 1;
    while (10 * length <= wanted) {
        length *= 10;
    }
    size_t step = 0;
    while (step < 3 && steps[step + 1] * length <= wanted) {
        ++step;
    }
    length *= steps[step];
    const double y = d->height - d->margin / 2;
    const double tick = d->letter / 3;
    fprintf(
        d->out,
        "<path class=\"scale\" d=\"M%.1f %.1fv%.1fh%.1fv%.1f\"/><text x=\"%.1f\" y=\"%.1f\">%g mm</text>\n",
        d->margin, y - tick, tick, length, -tick, d->margin + length + d->letter / 2, y, length);
    double x = d->margin + length + 7 * d->letter;
    for (size_t i = 0; i < WH_INKS; ++i) {
        fprintf(d->out,
                "<rect class=\"%s\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"/><text x=\"%.1f\" "
                "y=\"%.1f\">%s</text>\n",
                wh_ink_looks[i].class, x, y - 0.8 * d->letter, d->letter, d->letter, x + 1.5 * d->letter, y,
                wh_ink_looks[i].name);
        x += (3.5 + 0.62 * (double)strlen(wh_ink_looks[i].name)) * d->letter;
    }
}

static void draw_title(const drawing_t *d, double x, const char *what) {
    fprintf(d->out, "<text class=\"title\" x=\"%.1f\" y=\"%.1f\">", x, d->margin / 2 + d->letter);
    wh_svg_text(d->out, what);
    fputs("</text>\n", d->out);
}

int wh_layout_print_svg(const wh_feasibility_t *check, FILE *out) {
    drawing_t d = {.check = check, .out = out};
    measure(&d);
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.1f %.1f\" stroke-width=\"%.2f\" "
            "stroke-linejoin=\"round\">\n<title>",
            d.width, d.height, d.width / LINES_PER_WIDTH);
    wh_svg_text(out, check->layout->path);
    fputs("</title>\n", out);
    print_style(&d);
    fputs("<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n", out);
    const double side = d.width / 2 + d.margin / 2;
    draw_title(&d, d.margin, "from above");
    draw_title(&d, side, "from the side");
    draw_view(&d, WH_VIEW_TOP, d.margin, (double)d.low.y);
    draw_view(&d, WH_VIEW_SIDE, side, (double)d.low.z);
    draw_scale(&d);
    fputs("</svg>\n", out);
    wh_outline_free(&d.outline);
    return fflush(out) != 0 || ferror(out) ? -1 : 0;
}
