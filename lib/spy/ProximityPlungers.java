package waferhand;

import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/** The plungers of edge grips over time, from the states: each change for each gripper. */
final class ProximityPlungers {
    /** The grips' numbers in cell.lcm. */
    static final int VACUUM = 0, EDGE = 1, PASSIVE = 2;
    private static final int GRIPPERS = 16;
    /** The phases' numbers in gripper_state.lcm. */
    private static final String[] PHASES = {"open", "closes", "holds", "jammed", "missed", "opens"};

    /** One plunger from a slice on. */
    static final class Plunger {
        final long utime;
        final int phase;
        final double s, excess;

        Plunger(long utime, int phase, double s, double excess) {
            this.utime = utime;
            this.phase = phase;
            this.s = s;
            this.excess = excess;
        }

        /** Words such as "plunger -0.215 mm, holds". No message tells the place of an open plunger. */
        String words() {
            if (phase == 0) {
                return "plunger open";
            }
            final String does = phase >= 0 && phase < PHASES.length ? PHASES[phase] : "in phase " + phase;
            final String by = excess > 0 ? String.format(Locale.ROOT, " by %.3f mm", excess) : "";
            return String.format(Locale.ROOT, "plunger %.3f mm, %s%s", s, does, by);
        }

        private boolean isAs(Plunger other) {
            return phase == other.phase && s == other.s && excess == other.excess;
        }
    }

    private final List<ArrayList<Plunger>> seen = new ArrayList<>();

    ProximityPlungers() {
        for (int g = 0; g < GRIPPERS; g++) {
            seen.add(new ArrayList<>());
        }
    }

    /** Adds the plungers of one slice, by gripper; it is later than the slices before. */
    void add(List<Plunger> plungers) {
        for (int g = 0; g < plungers.size(); g++) {
            final ArrayList<Plunger> own = seen.get(g);
            if (own.isEmpty() || !own.get(own.size() - 1).isAs(plungers.get(g))) {
                own.add(plungers.get(g));
                ProximityMarks.forget(own);
            }
        }
    }

    /** The plunger of a gripper at that time, us; or null. */
    Plunger at(int gripper, double time) {
        final ArrayList<Plunger> own = seen.get(gripper);
        int from = 0, to = own.size();
        while (from < to) {
            final int middle = (from + to) / 2;
            if (own.get(middle).utime <= time) {
                from = middle + 1;
            } else {
                to = middle;
            }
        }
        return from > 0 ? own.get(from - 1) : null;
    }

    void clear() {
        seen.forEach(ArrayList::clear);
    }

    /** A copy that later messages do not change. */
    ProximityPlungers copy() {
        final ProximityPlungers other = new ProximityPlungers();
        for (int g = 0; g < GRIPPERS; g++) {
            other.seen.get(g).addAll(seen.get(g));
        }
        return other;
    }
}
