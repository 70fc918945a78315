"""What each patch of a skin feels: contact maps, motion and slip, patch by patch."""
