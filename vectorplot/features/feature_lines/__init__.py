"""Lines that show a shape where nothing turns away: suggestive contours, ridges and valleys, apparent ridges."""
