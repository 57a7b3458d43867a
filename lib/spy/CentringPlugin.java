package waferhand;

import java.awt.event.ActionEvent;
import java.io.IOException;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy's view of the beams' messages. It collects from lcm-spy's start, whether or not a view is open. */
public final class CentringPlugin implements SpyPlugin {
    private static final String CHANNEL = "WAFERHAND_LATCH";
    private final CentringPass.History history = new CentringPass.History();

    public CentringPlugin() {
        LCM.getSingleton().subscribe(CHANNEL, new Collector(history));
    }

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == centring.LCM_FINGERPRINT;
    }

    /** The action of a double click, in a desktop of its own. Both are null when only its name is asked for. */
    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new Open(desktop, history);
    }

    /** The collected centrings. */
    CentringPass.History history() {
        return history;
    }

    private static final class Collector implements LCMSubscriber {
        private final CentringPass.History history;

        Collector(CentringPass.History history) {
            this.history = history;
        }

        @Override
        public void messageReceived(LCM lcm, String channel, LCMDataInputStream data) {
            try {
                history.add(new centring(data));
            } catch (IOException | RuntimeException refused) {
                history.refuse();
            }
        }
    }

    private static final class Open extends AbstractAction {
        private static final long serialVersionUID = 1;
        private final transient JDesktopPane desktop;
        private final transient CentringPass.History history;

        Open(JDesktopPane desktop, CentringPass.History history) {
            super("Centring on the way");
            this.desktop = desktop;
            this.history = history;
        }

        @Override
        public void actionPerformed(ActionEvent event) {
            final CentringView view = new CentringView(history);
            SpyWindow.open(desktop, "Centring on the way: " + CHANNEL, view, view::stop);
            view.start();
        }
    }
}
