package waferhand;

import java.awt.BasicStroke;
import java.awt.Color;
import java.awt.Dimension;
import java.awt.Font;
import java.awt.FontMetrics;
import java.awt.Graphics;
import java.awt.Graphics2D;
import java.awt.Point;
import java.awt.Rectangle;
import java.awt.RenderingHints;
import java.awt.event.MouseAdapter;
import java.awt.event.MouseEvent;
import java.awt.event.MouseWheelEvent;
import java.util.List;
import java.util.Locale;
import javax.swing.JButton;
import javax.swing.JComponent;
import javax.swing.JPanel;
import javax.swing.Timer;

/** Each gripper's proximity values over simulated time, as in the paper's Fig. 9, with its valve, the wafer that it
 * holds, events and commands. The messages say which wafer is measured, and whether it is ready.
 */
final class ProximityView extends JPanel {
    private static final long serialVersionUID = 1;
    private static final String KEYS = "+ − time span   ← → scroll   L scale   space:";
    private static final double[] SPANS = {0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000};
    private static final String[] LANES = {"ready", "vacuum", "holds"};
    private static final int[] LANE_FLAGS = {ProximityHistory.READY, ProximityHistory.OPEN,
                                             ProximityHistory.HOLDS};
    private static final Color[] LANE_COLOURS = {ProximityChart.GOOD, new Color(0x56, 0xb4, 0xe9),
                                                 new Color(0xe6, 0x9f, 0x00)};
    static final Color PAPER = new Color(0xf7, 0xf7, 0xf7);
    private static final int FRAMES_PER_SECOND = 25;
    /** Painting may take this part of the time; a slow painting is repeated less often. */
    private static final int PAINTING_PART = 4;
    /** The greatest distance of the mouse from an event, pixels. */
    private static final int NEAR = 4;
    /** Without a message for this long, ns, the view says that it is waiting. */
    private static final long SILENCE = 1_000_000_000L;

    private final transient ProximityHistory live;
    /** A copy while the view is frozen, else null. Messages are still collected. */
    private transient ProximityHistory frozen;
    /** The history that is being painted. */
    private transient ProximityHistory shown;
    private final JButton freeze = new JButton("Freeze");
    private final Timer timer;
    private int span = 5;
    /** The distance of the right end behind the newest sample, us; 0 unless frozen. */
    private double behind;
    private boolean logarithmic = true;
    private int mouse = -1, mouseY;
    /** The text beside the mouse. */
    private transient List<String> words = List.of();
    private long lastSeen;
    private long lastChange = System.nanoTime();

    ProximityView(ProximityHistory history) {
        super(null);
        live = history;
        shown = history;
        timer = new Timer(1000 / FRAMES_PER_SECOND, event -> repaint());
        setFocusable(true);
        setBackground(PAPER);
        setPreferredSize(new Dimension(1100, 720));
        freeze.setFocusable(false); // its key is the view's
        freeze.addActionListener(event -> {
            freeze();
            repaint();
        });
        add(freeze);
        bind("SPACE", this::freeze);
        bind("typed +", () -> zoom(-1));
        bind("typed -", () -> zoom(1));
        bind("LEFT", () -> scroll(0.25));
        bind("RIGHT", () -> scroll(-0.25));
        bind("typed l", () -> logarithmic = !logarithmic);
        final MouseAdapter listener = new MouseAdapter() {
            @Override
            public void mousePressed(MouseEvent event) {
                requestFocusInWindow();
            }

            @Override
            public void mouseMoved(MouseEvent event) {
                mouse = event.getX();
                mouseY = event.getY();
            }

            @Override
            public void mouseExited(MouseEvent event) {
                mouse = -1;
            }

            @Override
            public void mouseWheelMoved(MouseWheelEvent event) {
                zoom(Integer.signum(event.getWheelRotation()));
            }
        };
        addMouseListener(listener);
        addMouseMotionListener(listener);
        addMouseWheelListener(listener);
    }

    /** Begins to follow the history, and takes the keys. */
    void start() {
        requestFocusInWindow();
        timer.start();
    }

    void stop() {
        timer.stop();
    }

    // ------------------------------------------------------------------------------------------- commands
    private void bind(String key, Runnable command) {
        SpyWindow.bind(this, key, command);
    }

    /** Stops the picture, or lets it continue. */
    void freeze() {
        behind = 0;
        frozen = frozen == null ? live.copy() : null;
        freeze.setText(frozen == null ? "Freeze" : "Go on");
        revalidate();
    }

    void zoom(int by) {
        span = Math.max(0, Math.min(SPANS.length - 1, span + by));
    }

    void scroll(double spans) {
        if (frozen == null) {
            freeze();
        }
        final ProximityHistory.Summary summary = frozen.summary();
        final double length = Math.max(0, (double)summary.last - summary.first - SPANS[span] * 1e6);
        behind = Math.max(0, Math.min(length, behind + spans * SPANS[span] * 1e6));
    }

    // ------------------------------------------------------------------------------------------- painting
    @Override
    protected void paintComponent(Graphics graphics) {
        super.paintComponent(graphics);
        final long begun = System.nanoTime();
        shown = frozen == null ? live.copy() : frozen;
        words = List.of();
        final Graphics2D g = (Graphics2D)graphics.create();
        g.setRenderingHint(RenderingHints.KEY_ANTIALIASING, RenderingHints.VALUE_ANTIALIAS_ON);
        g.setRenderingHint(RenderingHints.KEY_TEXT_ANTIALIASING, RenderingHints.VALUE_TEXT_ANTIALIAS_ON);
        final ProximityHistory.Summary summary = shown.summary();
        final int columns = summary.grippers > 4 ? (summary.grippers + 1) / 2 : Math.max(1, summary.grippers);
        final int rows = summary.grippers > 4 ? 2 : 1;
        g.setFont(font(columns, rows));
        final int line = g.getFontMetrics().getHeight();
        final int footer = footer(line);
        if (summary.grippers == 0) {
            centre(g, "Waiting for the first message …");
        }
        for (int k = 0; k < summary.grippers; k++) {
            final int left = getWidth() * (k % columns) / columns;
            final int right = getWidth() * (k % columns + 1) / columns;
            final int height = (getHeight() - footer) / rows;
            paintGripper(g, summary, k, new Rectangle(left, k / columns * height, right - left, height));
        }
        paintFooter(g, summary, line);
        ProximityTimes.paintWords(g, words, new Point(mouse, mouseY), getSize());
        g.dispose();
        final long took = (System.nanoTime() - begun) / 1_000_000;
        timer.setDelay((int)Math.max(1000 / FRAMES_PER_SECOND, PAINTING_PART * took));
    }

    private int footer(int line) {
        return Math.max(2 * line, freeze.getPreferredSize().height + 8);
    }

    @Override
    public void doLayout() {
        final Dimension size = freeze.getPreferredSize();
        freeze.setBounds(getWidth() - size.width - 8, getHeight() - size.height - 4, size.width, size.height);
    }

    private Font font(int columns, int rows) {
        final int size = Math.min(getWidth() / columns / 34, getHeight() / rows / 42);
        return new Font(Font.SANS_SERIF, Font.PLAIN, Math.max(11, Math.min(20, size)));
    }

    private void centre(Graphics2D g, String text) {
        g.setColor(ProximityChart.FAINT);
        g.drawString(text, (getWidth() - g.getFontMetrics().stringWidth(text)) / 2, getHeight() / 2);
    }

    private void paintGripper(Graphics2D g, ProximityHistory.Summary summary, int gripper, Rectangle area) {
        final int line = g.getFontMetrics().getHeight();
        final int axis = g.getFontMetrics().stringWidth("command") + 14;
        final int left = area.x + axis;
        final int width = Math.max(20, area.width - axis - line);
        // A run that is shorter than the axis begins at its left end.
        final double to = Math.max(summary.last - behind, summary.first + SPANS[span] * 1e6);
        final double from = to - SPANS[span] * 1e6;
        // To the right of the newest sample there is nothing, and it lies within.
        final ProximityHistory.Strip strip = shown.strip(gripper, from, Math.nextUp(to), width);
        final int x = mouse - left;
        final boolean pointed = x >= 0 && x < width;
        final double time = pointed ? from + (to - from) * (x + 1) / width : to;
        final ProximityHistory.Reading reading = shown.at(time);

        final ProximityTimes times = new ProximityTimes(from, to, left, width);
        final List<ProximityMarks.Event> events = shown.events(gripper, from, to);
        final List<ProximityMarks.Command> commands = shown.commands(from, Math.min(to, summary.last));
        final int rows = ProximityTimes.countRows(commands);

        int y = area.y + line / 2;
        paintHeader(g, summary, gripper, reading, time, new Rectangle(left, y, width, 3 * line));
        y += 3 * line;
        final int lanes = (LANES.length + 1 + rows) * (line + 3);
        final int each = Math.max(2 * line, (area.y + area.height - y - lanes - 2 * line) / 3);
        for (int v = 0; v < ProximityHistory.VALUES; v++) {
            final Rectangle plot = new Rectangle(left, y + line + 6, width, Math.max(4, each - line - 14));
            final double now = reading == null ? Double.NaN : reading.values[gripper][v];
            final int condition = ProximityHistory.CONDITION << v;
            final boolean good = reading != null && (reading.flags[gripper] & condition) != 0;
            new ProximityChart(v, summary.limits[v], plot, logarithmic).paint(g, strip, now, good);
            times.paintLines(g, events, plot.y, plot.y + plot.height);
            y += each;
        }
        y += 2;
        times.paintLines(g, events, y, y + LANES.length * (line + 3));
        for (int k = 0; k < LANES.length; k++) {
            final boolean isValve = k == 1 && summary.grips[gripper] != ProximityPlungers.VACUUM;
            paintLane(g, strip, k, isValve ? "valve" : LANES[k], new Rectangle(left, y, width, line));
            y += line + 3;
        }
        times.paintEvents(g, events, shown, new Rectangle(left, y, width, line));
        y += line + 3;
        for (int row = 0; row < rows; row++) {
            times.paintCommands(g, commands, row, new Rectangle(left, y, width, line));
            y += line + 3;
        }
        times.paintTicks(g, y);
        if (pointed) {
            g.setStroke(new BasicStroke(1));
            g.setColor(ProximityChart.INK);
            g.drawLine(mouse, area.y + 3 * line + line / 2, mouse, y);
            if (mouseY >= area.y && mouseY < area.y + area.height) {
                final boolean onLane = mouseY >= y - rows * (line + 3) && mouseY < y;
                words = times.words(mouse, onLane ? 0 : NEAR, onLane ? List.of() : events, commands, shown);
            }
        }
    }

    private void paintHeader(Graphics2D g, ProximityHistory.Summary summary, int gripper,
                             ProximityHistory.Reading reading, double time, Rectangle area) {
        final int line = g.getFontMetrics().getHeight();
        final int flags = reading == null ? 0 : reading.flags[gripper];
        final boolean ready = (flags & ProximityHistory.READY) != 0;
        final Font plain = g.getFont();
        g.setFont(plain.deriveFont(Font.BOLD, plain.getSize2D() * 1.25f));
        g.setColor(ProximityChart.INK);
        final String name = summary.names[gripper];
        final String title = name == null ? "gripper " + gripper : name;
        final int baseline = area.y + line;
        g.drawString(title, area.x, baseline);
        final int titleEnd = area.x + g.getFontMetrics().stringWidth(title + " ");

        g.setFont(plain.deriveFont(Font.BOLD));
        final int lamp = g.getFontMetrics().getAscent();
        final String verdict = "isReadyToPick" + (name == null ? "" : name) + "  " + ready;
        final String answer = fitting(g, area.x + area.width - titleEnd - lamp - 8, verdict, "ready", "");
        final int x = area.x + area.width - g.getFontMetrics().stringWidth(answer);
        g.drawString(answer, x, baseline);
        paintLamp(g, ready, x - lamp - 6, baseline - lamp + 1, lamp);

        g.setFont(plain);
        g.setColor(ProximityChart.INK);
        final String level = fitting(g, area.width, grip(summary, gripper, flags, time));
        final int second = baseline + line + 2;
        g.drawString(level, area.x, second);
        final int room = area.width - g.getFontMetrics().stringWidth(level + "  ");
        final String wafer = wafer(reading, gripper);
        final boolean holds = (flags & ProximityHistory.HOLDS) != 0;
        final String face = (flags & ProximityHistory.FRONT) != 0 ? " by its front" : "";
        final String text = wafer == null ? fitting(g, room, "no wafer", "")
                                          : fitting(g, room, (holds ? "holds " : "measured: ") + wafer + face,
                                                    wafer + face, "");
        g.drawString(text, area.x + area.width - g.getFontMetrics().stringWidth(text), second);
    }

    /** The valve and its effect, in words, and in fewer words; passive pads have none. */
    private String[] grip(ProximityHistory.Summary summary, int gripper, int flags, double time) {
        final boolean open = (flags & ProximityHistory.OPEN) != 0;
        final String valve = summary.valves[gripper] == null ? "valve" : summary.valves[gripper];
        final String position = valve + (open ? " = 0  open" : " = 1  closed");
        if (summary.grips[gripper] == ProximityPlungers.PASSIVE) {
            return new String[] {"passive pads", "passive", ""};
        } else if (summary.grips[gripper] == ProximityPlungers.EDGE) {
            final ProximityPlungers.Plunger plunger = shown.plunger(gripper, time);
            final String words = plunger == null ? "plunger unknown" : plunger.words();
            return new String[] {position + ", edge grip, " + words, words, open ? "open" : "closed", ""};
        }
        return new String[] {position + (open ? ", vacuum on" : ""), position, open ? "open" : "closed", ""};
    }

    private String wafer(ProximityHistory.Reading reading, int gripper) {
        return reading == null ? null : shown.waferName(reading.wafer[gripper]);
    }

    /** The first of the texts that is no wider than that, or the last. */
    static String fitting(Graphics2D g, int width, String... texts) {
        for (final String text : texts) {
            if (g.getFontMetrics().stringWidth(text) <= width) {
                return text;
            }
        }
        return texts[texts.length - 1];
    }

    /** On: a disc. Off: a ring. */
    private static void paintLamp(Graphics2D g, boolean on, int x, int y, int size) {
        g.setStroke(new BasicStroke(2));
        if (on) {
            g.setColor(ProximityChart.GOOD);
            g.fillOval(x, y, size, size);
        }
        g.setColor(on ? ProximityChart.GOOD : ProximityChart.FAINT);
        g.drawOval(x, y, size, size);
    }

    private static void paintLane(Graphics2D g, ProximityHistory.Strip strip, int lane, String name,
                                  Rectangle area) {
        final FontMetrics metrics = g.getFontMetrics();
        g.setColor(ProximityChart.FAINT);
        g.drawString(name, area.x - metrics.stringWidth(name) - 6, area.y + metrics.getAscent());
        g.setColor(ProximityChart.GRID);
        g.fillRect(area.x, area.y + area.height / 2, area.width, 1);
        g.setColor(LANE_COLOURS[lane]);
        int before = -1;
        for (int x = 0; x < area.width; x++) {
            if (strip.samples[x] == 0) {
                continue;
            }
            if ((strip.flags[x] & LANE_FLAGS[lane]) != 0) {
                final boolean goesOn =
                    before >= 0 && strip.joined[x] && (strip.flags[before] & LANE_FLAGS[lane]) != 0;
                final int from = goesOn ? before : x;
                g.fillRect(area.x + from, area.y + 2, x + 1 - from, area.height - 4);
            }
            before = x;
        }
    }

    private void paintFooter(Graphics2D g, ProximityHistory.Summary summary, int line) {
        final int footer = footer(line);
        final FontMetrics metrics = g.getFontMetrics();
        final int y = getHeight() - footer / 2 + metrics.getAscent() / 2 - 1;
        g.setColor(ProximityChart.GRID);
        g.fillRect(0, getHeight() - footer, getWidth(), 1);
        final int button = getWidth() - freeze.getPreferredSize().width - 8;
        final int end = button - metrics.stringWidth(KEYS) - 4;
        g.setColor(ProximityChart.FAINT);
        final String text = status(summary);
        g.drawString(fitting(g, button - 2 * line, text, text.replaceFirst(" {3}run [0-9a-f]*", ""),
                             text.replaceFirst(" {3}run .*", "")),
                     line, y);
        if (line + metrics.stringWidth(text) + line < end) {
            g.drawString(KEYS, end, y);
        }
    }

    private String status(ProximityHistory.Summary summary) {
        final StringBuilder text = new StringBuilder();
        text.append(String.format(Locale.ROOT, "%.3f s", summary.last / 1e6));
        if (frozen != null) {
            text.append(String.format(Locale.ROOT, ", frozen; now %.3f s", live.summary().last / 1e6));
        } else if (isSilent(summary)) {
            text.append(", no new messages");
        }
        text.append(
            String.format(Locale.ROOT, "   run %016x   %d slices measured", summary.run, summary.seen));
        append(text, summary.statesMissing, "states missing");
        append(text, summary.late, "late");
        append(text, summary.refused, "refused");
        return text.toString();
    }

    private static void append(StringBuilder text, long number, String what) {
        if (number > 0) {
            text.append(", ").append(number).append(' ').append(what);
        }
    }

    private boolean isSilent(ProximityHistory.Summary summary) {
        final long now = System.nanoTime();
        if (summary.seen != lastSeen) {
            lastSeen = summary.seen;
            lastChange = now;
        }
        return summary.grippers > 0 && now - lastChange > SILENCE;
    }
}
