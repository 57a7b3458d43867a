package waferhand;

import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.stream.Collectors;

/** A whole scan of a wafer's edge, put together from its parts: each sample, the fitted circle, and the estimate in
 * words. */
final class EdgeScan {
    final long run;
    final long utime;
    final int number, gripper, taken, missed;
    /** Whether the estimate is sure of all that it says. */
    final boolean sure;
    /** The verdict comes first. */
    final List<String> lines;
    /** The direction in which the sensor looked, degrees; the place of the rim along it, mm; its distance outside of
     * the circle, um. NaN where the rim was not seen, the sample is missing, or there is no circle. */
    final double[] theta, rho, residual;
    /** Whether a sample counts for the circle. */
    final boolean[] counts;
    /** The circle, mm; the radius is 0 without one. */
    final double x, y, radius;
    /** The direction in which the axis sees the notch or flat, degrees, or NaN. */
    final double markAt;
    final boolean isNotch;

    private EdgeScan(edge_scan[] parts) {
        final edge_scan first = parts[0];
        run = first.run;
        utime = first.utime;
        number = first.number;
        gripper = first.gripper;
        taken = first.taken;
        missed = first.missed;
        sure = first.verdict == 0;
        lines = Arrays.stream(first.lines).map(EdgeScan::text).collect(Collectors.toUnmodifiableList());
        x = first.x;
        y = first.y;
        radius = first.radius;
        markAt = Math.toDegrees(first.mark_at);
        isNotch = first.mark == 1;
        theta = new double[taken];
        rho = new double[taken];
        residual = new double[taken];
        counts = new boolean[taken];
        for (final edge_scan part : parts) {
            take(part);
        }
    }

    /** LCM's Java takes each byte of a text as a character; our texts are UTF-8. */
    private static String text(String told) {
        return new String(told.getBytes(StandardCharsets.ISO_8859_1), StandardCharsets.UTF_8);
    }

    private void take(edge_scan part) {
        final int turn = Math.max(1, part.turn_samples);
        for (int i = 0; i < part.sample_count; i++) {
            final int k = part.begin + i;
            final long number = part.first + (part.count < 0 ? -k : k);
            final double angle =
                Math.toDegrees(part.direction) - 360.0 * Math.floorMod(number, (long)turn) / turn;
            final boolean seen = part.samples[i] > 0 && part.samples[i] < part.pixels;
            theta[k] = angle - 360 * Math.floor(angle / 360);
            rho[k] = seen ? part.inner + (part.samples[i] + 0.5) * part.pixel : Double.NaN;
            residual[k] = 1000 * part.residual[i];
            counts[k] = part.counts[i] != 0;
        }
    }

    /** The circle's rim in a direction, mm; NaN without a circle. */
    double circle(double degrees) {
        final double a = Math.toRadians(degrees);
        final double aside = x * Math.sin(a) - y * Math.cos(a);
        return radius > 0 ? x * Math.cos(a) + y * Math.sin(a) + Math.sqrt(radius * radius - aside * aside)
                          : Double.NaN;
    }

    /** The sample that is nearest to a direction, or -1. */
    int nearest(double degrees) {
        int found = -1;
        for (int i = 0; i < taken; i++) {
            if (found < 0 || Math.abs(theta[i] - degrees) < Math.abs(theta[found] - degrees)) {
                found = i;
            }
        }
        return found;
    }

    /** The last scans of a channel, put together from their parts. */
    static final class History {
        static final int MOST = 100;
        private final List<EdgeScan> scans = new ArrayList<>();
        private edge_scan[] parts = new edge_scan[0];
        private long refused, incomplete;

        /** Takes a part. Returns false, and counts it, if it does not make sense. */
        synchronized boolean add(edge_scan part) {
            if (!isSound(part)) {
                refused++;
                return false;
            }
            if (parts.length == 0 || !belongs(part)) {
                incomplete += parts.length == 0 ? 0 : 1;
                parts = new edge_scan[part.parts];
            }
            parts[part.part - 1] = part;
            if (Arrays.stream(parts).noneMatch(each -> each == null)) {
                keep();
            }
            return true;
        }

        /** Parts that come again, for example from a log that is played again, make the scan again. */
        private void keep() {
            final edge_scan[] whole = parts;
            parts = new edge_scan[0];
            if (Arrays.stream(whole).mapToInt(each -> each.sample_count).sum() != whole[0].taken) {
                refused++;
                return;
            }
            final EdgeScan scan = new EdgeScan(whole);
            scans.removeIf(each -> each.run == scan.run && each.number == scan.number);
            scans.add(scan);
            if (scans.size() > MOST) {
                scans.remove(0);
            }
        }

        private boolean belongs(edge_scan part) {
            for (final edge_scan each : parts) {
                if (each != null) {
                    return each.run == part.run && each.number == part.number && each.parts == part.parts &&
                        each.taken == part.taken;
                }
            }
            return false;
        }

        private static boolean isSound(edge_scan part) {
            return part.parts >= 1 && part.parts <= 1000 && part.part >= 1 && part.part <= part.parts &&
                part.taken >= 0 && part.taken <= 1_000_000 && part.begin >= 0 && part.sample_count >= 0 &&
                part.begin <= part.taken - part.sample_count && part.samples.length == part.sample_count;
        }

        synchronized void refuse() {
            refused++;
        }

        synchronized List<EdgeScan> scans() {
            return List.copyOf(scans);
        }

        /** The losses in words; empty if there are none. */
        synchronized String lost() {
            return (incomplete > 0 ? incomplete + " scans came in part only " : "") +
                (refused > 0 ? refused + " messages refused" : "");
        }
    }
}
