package waferhand;

import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/** Messages of beams about a wafer that passed them, as numbers and in words. */
final class CentringPass {
    /** The error's number if the centre is not sure. */
    static final int TOO_FEW_SAMPLES = 70;
    static final int CENTRE_NOT_SURE = 75;

    final centring told;
    final boolean sure;
    /** The verdict comes first. */
    final List<String> lines = new ArrayList<>();

    private CentringPass(centring told) {
        this.told = told;
        sure = told.status == 0;
        lines.add(verdict(told));
        for (int i = 0; i < told.centre_count; i++) {
            lines.add(place(told, i));
        }
        lines.add(String.format(Locale.ROOT, "%d crossings, %d latches missed%s", told.crossing_count,
                                told.missed,
                                told.centre_count == 0 ? "; no place of the wafer is told" : ""));
    }

    private static String verdict(centring told) {
        switch (told.status) {
        case 0:
            return "the estimate is sure";
        case TOO_FEW_SAMPLES:
            return "no estimate: 70 TOO_FEW_SAMPLES";
        case CENTRE_NOT_SURE:
            return "not sure: 75 CENTRE_NOT_SURE";
        default:
            return "no estimate: error " + told.status;
        }
    }

    private static String place(centring told, int i) {
        final centre at = told.centres[i];
        return String.format(
            Locale.ROOT,
            "%s: x %.4f, y %.4f mm on the blade, standard deviations %.2f and %.2f µm, radius "
                + "%.4f mm, %d crossings used",
            name(told, i), at.x, at.y, 1000 * at.sd_x, 1000 * at.sd_y, at.radius, at.used);
    }

    /** The name of a place; a place that is not sure is not called the centre. */
    static String name(centring told, int i) {
        if (told.status == 0) {
            return i == 0 ? "centre" : "as near as the same";
        }
        return told.centre_count < 2 ? "not likely" : i == 0 ? "likelier place" : "other place";
    }

    /** The distance of a crossing outside of a place's circle, µm. */
    double residual(int place, int crossing) {
        final centre at = told.centres[place];
        final crossing of = told.crossings[crossing];
        return 1000 * (Math.hypot(of.x - at.x, of.y - at.y) - at.radius);
    }

    /** The last centrings of a channel. */
    static final class History {
        static final int MOST = 200;
        private final List<CentringPass> list = new ArrayList<>();
        private long refused;

        /** Returns false, and counts it, if the message does not make sense. A message that comes again, for example
         * from a log that is played again, replaces the old one. */
        synchronized boolean add(centring told) {
            if (!isSound(told)) {
                refused++;
                return false;
            }
            list.removeIf(each -> each.told.run == told.run && each.told.number == told.number);
            list.add(new CentringPass(told));
            if (list.size() > MOST) {
                list.remove(0);
            }
            return true;
        }

        private static boolean isSound(centring told) {
            boolean sound = told.crossing_count >= 0 && told.crossing_count <= 16 && told.centre_count >= 0 &&
                            told.centre_count <= 2;
            for (int i = 0; sound && i < told.crossing_count; i++) {
                sound = isPlace(told.crossings[i].x, told.crossings[i].y);
            }
            for (int i = 0; sound && i < told.centre_count; i++) {
                final double radius = told.centres[i].radius;
                sound = isPlace(told.centres[i].x, told.centres[i].y) && radius > 0 && radius < 1000;
            }
            return sound;
        }

        private static boolean isPlace(double x, double y) {
            return Math.abs(x) <= 1000 && Math.abs(y) <= 1000;
        }

        synchronized void refuse() {
            refused++;
        }

        synchronized List<CentringPass> list() {
            return List.copyOf(list);
        }

        /** The losses in words; empty if there are none. */
        synchronized String lost() {
            return refused > 0 ? refused + " messages refused" : "";
        }
    }
}
