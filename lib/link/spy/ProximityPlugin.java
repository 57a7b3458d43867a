package waferhand;

import java.awt.BorderLayout;
import java.awt.Dimension;
import java.awt.Window;
import java.awt.event.ActionEvent;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import java.io.IOException;
import java.util.regex.Pattern;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.SwingUtilities;
import javax.swing.WindowConstants;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy's view of a channel of proximity messages. lcm-spy finds it by its interface. */
public final class ProximityPlugin implements SpyPlugin {
    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == proximity.LCM_FINGERPRINT;
    }

    /** The action that a double click does, in a desktop of its own. Both are null when only its name is asked for. */
    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new Open(desktop, channel);
    }

    /** Fills a history from two channels. */
    static final class Feed implements LCMSubscriber {
        private final ProximityHistory history;
        private final String channel, names;

        Feed(ProximityHistory history, String channel) {
            this.history = history;
            this.channel = channel;
            this.names = channel.replaceFirst("PROXIMITY$", "CELL");
        }

        void subscribe(LCM lcm) {
            lcm.subscribe(Pattern.quote(channel), this);
            lcm.subscribe(Pattern.quote(names), this);
        }

        void unsubscribe(LCM lcm) {
            lcm.unsubscribe(Pattern.quote(channel), this);
            lcm.unsubscribe(Pattern.quote(names), this);
        }

        @Override
        public void messageReceived(LCM lcm, String from, LCMDataInputStream data) {
            try {
                if (from.equals(channel)) {
                    history.add(new proximity(data));
                } else {
                    history.add(new ProximityNames(data));
                }
            } catch (IOException | RuntimeException refused) {
                history.refuse();
            }
        }
    }

    private static final class Open extends AbstractAction {
        private static final long serialVersionUID = 1;
        private final transient JDesktopPane desktop;
        private final transient ChannelData channel;

        Open(JDesktopPane desktop, ChannelData channel) {
            super("Proximity against its limits");
            this.desktop = desktop;
            this.channel = channel;
        }

        @Override
        public void actionPerformed(ActionEvent event) {
            final ProximityHistory history = new ProximityHistory();
            final Feed feed = new Feed(history, channel.name);
            final ProximityView view = new ProximityView(history);
            final JFrame frame = frame();
            frame.setTitle("Proximity: " + channel.name);
            frame.getContentPane().removeAll();
            frame.getContentPane().setLayout(new BorderLayout());
            frame.getContentPane().add(view);
            frame.setDefaultCloseOperation(WindowConstants.DISPOSE_ON_CLOSE);
            frame.addWindowListener(new WindowAdapter() {
                @Override
                public void windowClosed(WindowEvent closed) {
                    feed.unsubscribe(LCM.getSingleton());
                    view.stop();
                }
            });
            frame.setMinimumSize(new Dimension(480, 420));
            frame.setSize(1100, 760);
            frame.setVisible(true);
            frame.validate();
            view.start();
            feed.subscribe(LCM.getSingleton());
        }

        /** The window that lcm-spy has opened around its desktop, else one of our own. */
        private JFrame frame() {
            final Window window = desktop == null ? null : SwingUtilities.getWindowAncestor(desktop);
            return window instanceof JFrame ? (JFrame)window : new JFrame();
        }
    }
}
