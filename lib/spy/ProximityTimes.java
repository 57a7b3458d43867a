package waferhand;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Font;
import java.awt.FontMetrics;
import java.awt.Graphics2D;
import java.awt.Point;
import java.awt.Rectangle;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/** The time axis of one gripper's charts, with the events and commands that are marked on it. */
final class ProximityTimes {
    /** The colours of alarms, of usual events, and of the boxes of commands. */
    private static final Color ALARM = ProximityChart.LIMIT, USUAL = new Color(0x55, 0x55, 0x55),
                               COMMAND = new Color(0xdc, 0xe3, 0xea);
    private static final Color PALE_ALARM = new Color(0xd5, 0x5e, 0x00, 0x90),
                               PALE_USUAL = new Color(0x55, 0x55, 0x55, 0x60);
    private static final BasicStroke DOTTED =
        new BasicStroke(1, BasicStroke.CAP_BUTT, BasicStroke.JOIN_MITER, 10, new float[] {2, 3}, 0);

    private static final int MOST_ROWS = 4;

    private final double from, to;
    private final int left, width;

    /** The axis reaches from one time to another, us, over this width. */
    ProximityTimes(double from, double to, int left, int width) {
        this.from = from;
        this.to = to;
        this.left = left;
        this.width = width;
    }

    private int x(double utime) {
        final double part = Math.max(0, Math.min(1, (utime - from) / (to - from)));
        return left + (int)Math.min(width - 1, part * width);
    }

    void paintTicks(Graphics2D g, int y) {
        final FontMetrics metrics = g.getFontMetrics();
        final double seconds = (to - from) / 1e6;
        final double step = ProximityChart.niceStep(seconds * metrics.stringWidth("0000.00 s") / width);
        g.setColor(ProximityChart.FAINT);
        for (double tick = Math.ceil(Math.max(0, from) / 1e6 / step) * step; tick * 1e6 <= to; tick += step) {
            final int x = left + (int)Math.round((tick * 1e6 - from) / (to - from) * width);
            final String text = ProximityChart.shortest(tick) + " s";
            g.drawLine(x, y, x, y + 3);
            final int wide = metrics.stringWidth(text);
            final int begin = Math.min(x - wide / 2, left + width + metrics.getHeight() / 2 - wide);
            g.drawString(text, begin, y + 4 + metrics.getAscent());
        }
    }

    private static void laneName(Graphics2D g, String name, Rectangle lane) {
        final FontMetrics metrics = g.getFontMetrics();
        g.setColor(ProximityChart.FAINT);
        g.drawString(name, lane.x - metrics.stringWidth(name) - 6, lane.y + metrics.getAscent());
        g.setColor(ProximityChart.GRID);
        g.fillRect(lane.x, lane.y + lane.height / 2, lane.width, 1);
    }

    /** Uses smaller letters within a lane. Returns the baseline there. */
    private static int small(Graphics2D g, Rectangle lane) {
        g.setFont(g.getFont().deriveFont(Math.max(10f, 0.75f * g.getFont().getSize2D())));
        final FontMetrics metrics = g.getFontMetrics();
        return lane.y + (lane.height + metrics.getAscent() - metrics.getDescent()) / 2;
    }

    /** A line at each event. */
    void paintLines(Graphics2D g, List<ProximityMarks.Event> events, int top, int bottom) {
        g.setStroke(DOTTED);
        int before = -1;
        for (final ProximityMarks.Event event : events) {
            final int x = x(event.utime);
            if (x != before || !event.isWelcome()) {
                g.setColor(event.isWelcome() ? PALE_USUAL : PALE_ALARM);
                g.drawLine(x, top, x, bottom);
            }
            before = x;
        }
    }

    /** A triangle at each event, and its name where there is room up to the next one. */
    void paintEvents(Graphics2D g, List<ProximityMarks.Event> events, ProximityHistory names,
                     Rectangle lane) {
        laneName(g, "events", lane);
        final Font plain = g.getFont();
        final int baseline = small(g, lane);
        final int size = Math.max(3, lane.height / 4);
        for (int k = 0; k < events.size(); k++) {
            final ProximityMarks.Event event = events.get(k);
            final int x = x(event.utime);
            final int next = k + 1 < events.size() ? x(events.get(k + 1).utime) - size : lane.x + lane.width;
            if (next + size == x && !events.get(k + 1).isWelcome()) {
                continue; // what is wrong is seen before what is right
            }
            g.setColor(event.isWelcome() ? USUAL : ALARM);
            g.fillPolygon(new int[] {x - size, x + size, x},
                          new int[] {lane.y + 3, lane.y + 3, lane.y + 3 + 2 * size}, 3);
            paintName(g, event, names, x + size + 2, next - 2, baseline);
        }
        g.setFont(plain);
    }

    private static void paintName(Graphics2D g, ProximityMarks.Event event, ProximityHistory names, int begin,
                                  int end, int baseline) {
        final FontMetrics metrics = g.getFontMetrics();
        final String wafer = names.waferName(event.wafer);
        final String whole = wafer == null ? event.name() : event.name() + " " + wafer;
        final String text = ProximityView.fitting(g, end - begin, whole, event.name(), "");
        final Color ink = g.getColor();
        g.setColor(ProximityView.PAPER);
        g.fillRect(begin, baseline - metrics.getAscent(), metrics.stringWidth(text), metrics.getHeight());
        g.setColor(ink);
        g.drawString(text, begin, baseline);
    }

    /** Draws a row of commands: a box from each one's begin to its end, with its line where there is room. */
    void paintCommands(Graphics2D g, List<ProximityMarks.Command> commands, int row, Rectangle lane) {
        laneName(g, row == 0 ? "command" : "beside", lane);
        final Font plain = g.getFont();
        final int baseline = small(g, lane);
        final int[] rows = ProximityMarks.rows(commands);
        for (int k = 0; k < rows.length; k++) {
            if (Math.min(rows[k], MOST_ROWS - 1) == row) {
                paintCommand(g, commands.get(k), lane, baseline);
            }
        }
        g.setFont(plain);
    }

    /** The number of rows of commands: at least one; commands that would need more share the last one. */
    static int countRows(List<ProximityMarks.Command> commands) {
        int most = 0;
        for (final int row : ProximityMarks.rows(commands)) {
            most = Math.max(most, row);
        }
        return Math.min(most + 1, MOST_ROWS);
    }

    private void paintCommand(Graphics2D g, ProximityMarks.Command command, Rectangle lane, int baseline) {
        final int begin = x(command.begin);
        final int wide = Math.max(2, x(command.end) - begin - 1);
        final boolean failed = command.phase == ProximityMarks.Command.FAILED;
        g.setColor(failed ? ALARM : COMMAND);
        g.fillRect(begin, lane.y, wide, lane.height - 1);
        final String result = failed ? command.text + ": error " + command.error : command.text;
        final String text = ProximityView.fitting(g, wide - 4, result, command.text, "");
        g.setColor(failed ? Color.WHITE : ProximityChart.INK);
        g.drawString(text, begin + (wide - g.getFontMetrics().stringWidth(text)) / 2, baseline);
    }

    /** The marks near a place: a line or two for each event, one for the command. */
    List<String> words(int x, int near, List<ProximityMarks.Event> events,
                       List<ProximityMarks.Command> commands, ProximityHistory names) {
        final List<String> words = new ArrayList<>();
        for (final ProximityMarks.Event event : events) {
            if (Math.abs(x(event.utime) - x) <= near && words.size() < 12) {
                words.add(words(event, names));
                final String values = event.values();
                if (!values.isEmpty()) {
                    words.add("    " + values);
                }
            }
        }
        for (final ProximityMarks.Command command : commands) {
            if ((near == 0 || !words.isEmpty()) && x >= x(command.begin) && x < x(command.end)) {
                words.add(words(command));
            }
        }
        return words;
    }

    private static String words(ProximityMarks.Event event, ProximityHistory names) {
        final String wafer = names.waferName(event.wafer);
        final String gripper = names.gripperName(event.gripper);
        return String.format(Locale.ROOT, "%.3f s  %s%s%s", event.utime / 1e6, event.name(),
                             wafer == null ? "" : " " + wafer, gripper == null ? "" : " by " + gripper);
    }

    private static String words(ProximityMarks.Command command) {
        final String task = command.task > 0 ? ", task " + command.task : "";
        final String line = command.line > 0 ? " (line " + command.line + task + ")" : "";
        final String result = command.phase == ProximityMarks.Command.FAILED
                                  ? ": error " + command.error + ", " + command.result
                                  : "";
        return command.text + line + result;
    }

    /** A box of lines beside the mouse, within the picture. */
    static void paintWords(Graphics2D g, List<String> words, Point mouse, Dimension picture) {
        final FontMetrics metrics = g.getFontMetrics();
        int wide = 0;
        for (final String text : words) {
            wide = Math.max(wide, metrics.stringWidth(text) + 12);
        }
        if (words.isEmpty()) {
            return;
        }
        final int high = words.size() * metrics.getHeight() + 8;
        final int at = Math.max(0, Math.min(mouse.x + 12, picture.width - wide - 4));
        final int top = Math.max(0, Math.min(mouse.y + 12, picture.height - high - 4));
        g.setStroke(new BasicStroke(1));
        g.setColor(Color.WHITE);
        g.fillRect(at, top, wide, high);
        g.setColor(ProximityChart.FAINT);
        g.drawRect(at, top, wide, high);
        g.setColor(ProximityChart.INK);
        for (int k = 0; k < words.size(); k++) {
            g.drawString(words.get(k), at + 6, top + 4 + k * metrics.getHeight() + metrics.getAscent());
        }
    }
}
