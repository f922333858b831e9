"""What a platform is: its joints, its legs and what they allow, and the poses it is asked about."""
