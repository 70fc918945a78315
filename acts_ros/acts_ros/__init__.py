"""See package.xml."""
